// Runs in the browser: Babylon.js' own loader, animation and drawing, evaluated where we can read numbers.
/* global BABYLON */
BABYLON.MeshoptCompression.Configuration = { decoder: { url: '/modules/meshoptimizer/meshopt_decoder.cjs' } };
const engine = new BABYLON.Engine(document.getElementById('canvas'), false);

/** The index that a pointer like /nodes/3 among a mesh's origins has, or undefined. */
function originOf(object, pattern) {
  for (const pointer of object?._internalMetadata?.gltf?.pointers ?? []) {
    const found = pattern.exec(pointer);
    if (found) return found.slice(1).map(Number);
  }
  return object?.parent ? originOf(object.parent, pattern) : undefined;
}

function describeMesh(mesh) {
  const [index, primitive] = originOf(mesh.sourceMesh ?? mesh, /^\/meshes\/(\d+)\/primitives\/(\d+)$/);
  return { node: originOf(mesh, /^\/nodes\/(\d+)$/)?.[0], mesh: index, primitive,
    vertices: mesh.getTotalVertices(), targets: mesh.morphTargetManager?.numTargets ?? 0 };
}

function placedPositions(mesh) {
  const local = mesh.getPositionData(true, true);
  const matrix = mesh.computeWorldMatrix(true);
  const placed = new Float64Array(local.length);
  for (let i = 0; i < local.length; i += 3)
    BABYLON.Vector3.TransformCoordinates(BABYLON.Vector3.FromArray(local, i), matrix).toArray(placed, i);
  return placed;
}

/** Loads a file, puts its last clip to `time` and draws it; numbers are posted, their layout is returned. */
window.evaluate = async (url, time) => {
  const scene = new BABYLON.Scene(engine);
  scene.useRightHandedSystem = true;
  await BABYLON.SceneLoader.AppendAsync('', url, scene, undefined, '.glb');
  new BABYLON.ArcRotateCamera('camera', 1, 1, 5, BABYLON.Vector3.Zero(), scene);
  await scene.whenReadyAsync();
  for (const clip of scene.animationGroups) clip.stop();
  const clip = scene.animationGroups.at(-1);
  if (clip) {
    clip.start(false);
    clip.goToFrame(time * clip.targetedAnimations[0].animation.framePerSecond);
    clip.pause();
  }
  scene.render();
  const meshes = scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0);
  const values = meshes.map(placedPositions);
  const total = values.reduce((sum, each) => sum + each.length, 0);
  const all = new Float64Array(total);
  let offset = 0;
  for (const each of values) all.set(each, offset), offset += each.length;
  await fetch('/result/positions', { method: 'POST', body: new Blob([all]) });
  const result = { places: meshes.map(describeMesh), clips: scene.animationGroups.length };
  scene.dispose();
  return result;
};
window.ready = true;
