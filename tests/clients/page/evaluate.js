// Runs in the browser: three.js' own loader, mixer and morphing, evaluated where we can read numbers.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

/** Each further scene of a file makes the parser forget what it knows of the others. */
function keepAssociations(parser) {
  const all = parser.associations;
  Object.defineProperty(parser, 'associations',
    { get: () => all, set: (some) => some.forEach((value, key) => all.set(key, value)) });
  return { name: 'keepAssociations' };
}

/** Loads a file and readies one of its clips to be put to any time. */
async function openGltf(url, clip = 0) {
  const gltf = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).register(keepAssociations).loadAsync(url);
  const meshes = [];
  gltf.scene.traverse((object) => { if (object.isMesh) meshes.push(object); });
  const primitiveOf = (mesh) => gltf.parser.associations.get(mesh).primitives ?? 0;
  meshes.sort((a, b) => primitiveOf(a) - primitiveOf(b));
  const mixer = new THREE.AnimationMixer(gltf.scene);
  const action = gltf.animations.length ? mixer.clipAction(gltf.animations.at(clip)) : null;
  // A loop would show the first frame at the clip's last moment.
  action?.setLoop(THREE.LoopOnce, 1).play();
  if (action) action.clampWhenFinished = true;
  return { gltf, meshes, mixer, action };
}

function putToTime({ gltf, mixer, action }, time) {
  if (action) {
    action.paused = false;
    action.time = time;
    mixer.update(0);
  }
  gltf.scene.updateMatrixWorld(true);
}

function writePositions(mesh, values, offset) {
  const point = new THREE.Vector3();
  for (let i = 0; i < mesh.geometry.attributes.position.count; i++)
    mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld).toArray(values, offset + 3 * i);
}

/** As the shader chunk morphnormal_vertex has it: base plus weighted deltas, then the normal matrix. */
function writeNormals(mesh, values, offset) {
  const { attributes: { normal }, morphAttributes, morphTargetsRelative } = mesh.geometry;
  if (!normal) return values.fill(NaN, offset, offset + 3 * mesh.geometry.attributes.position.count);
  if (morphAttributes.normal && !morphTargetsRelative) throw new Error('absolute morph targets');
  const toWorld = new THREE.Matrix3().getNormalMatrix(mesh.matrixWorld);
  const [sum, delta] = [new THREE.Vector3(), new THREE.Vector3()];
  for (let i = 0; i < normal.count; i++) {
    sum.fromBufferAttribute(normal, i);
    morphAttributes.normal?.forEach((target, k) =>
      sum.addScaledVector(delta.fromBufferAttribute(target, i), mesh.morphTargetInfluences[k]));
    sum.applyMatrix3(toWorld).normalize().toArray(values, offset + 3 * i);
  }
}

const post = (name, array) => fetch(`/result/${name}`, { method: 'POST', body: new Blob([array]) });

/** Where in the file a mesh of the scene comes from, and what it has. */
function describeMesh({ parser }, mesh) {
  const { meshes, primitives } = parser.associations.get(mesh);
  let object = mesh;
  while (object && parser.associations.get(object)?.nodes === undefined) object = object.parent;
  return { node: parser.associations.get(object).nodes, mesh: meshes, primitive: primitives ?? 0,
    vertices: mesh.geometry.attributes.position.count, targets: mesh.geometry.morphAttributes.position?.length ?? 0 };
}

/** Evaluates a file at `times` of one of its clips; numbers are posted, their layout is returned. */
window.evaluate = async (url, times, clip = 0) => {
  const opened = await openGltf(url, clip);
  const counts = opened.meshes.map((mesh) => mesh.geometry.attributes.position.count);
  const total = counts.reduce((sum, count) => sum + count, 0);
  const positions = new Float64Array(3 * total * times.length);
  const normals = new Float64Array(3 * total * times.length);
  let offset = 0;
  for (const time of times) {
    putToTime(opened, time);
    for (const mesh of opened.meshes) {
      writePositions(mesh, positions, offset);
      writeNormals(mesh, normals, offset);
      offset += 3 * mesh.geometry.attributes.position.count;
    }
  }
  await post('positions', positions);
  await post('normals', normals);
  for (const [k, mesh] of opened.meshes.entries())
    await post(`indices/${k}`, Uint32Array.from(mesh.geometry.index?.array ?? Array(counts[k]).keys()));
  const places = opened.meshes.map((mesh) => describeMesh(opened.gltf, mesh));
  return { counts, places, clips: opened.gltf.animations.map(({ name, duration }) => ({ name, duration })),
    targets: Object.keys(opened.meshes[0]?.morphTargetDictionary ?? {}) };
};

function lookAt(box, aspect) {
  const centre = box.getCenter(new THREE.Vector3());
  const radius = box.getSize(new THREE.Vector3()).length() / 2;
  const camera = new THREE.PerspectiveCamera(30, aspect, radius / 10, radius * 20);
  camera.position.copy(centre).addScaledVector(new THREE.Vector3(1, 0.7, 2).normalize(), radius * 4.2);
  camera.lookAt(centre);
  return camera;
}

/** Draws one moment by WebGL into the page, to be photographed. */
window.show = async (url, time, size) => {
  const opened = await openGltf(url);
  const renderer = new THREE.WebGLRenderer({ antialias: true });
  renderer.setSize(size, size);
  document.body.replaceChildren(renderer.domElement);
  document.body.style.margin = 0;
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xdddddd);
  const sun = new THREE.DirectionalLight(0xffffff, 3);
  sun.position.set(1, 2, 1.5);
  scene.add(opened.gltf.scene, sun, new THREE.HemisphereLight(0xffffff, 0x667788, 1.5));
  putToTime(opened, time);
  renderer.render(scene, lookAt(new THREE.Box3().setFromObject(opened.gltf.scene, true), 1));
};
window.ready = true;
