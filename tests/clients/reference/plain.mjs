// Any .gltf or .glb in one plain form: one run of bytes, nothing compressed, nothing outside. Shares nothing with morphbake.
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { requireModule } from '../support.mjs';
import { parseGlb } from './glb.mjs';

const MESHOPT = 'EXT_meshopt_compression';
const DRACO = 'KHR_draco_mesh_compression';
const UNPACKED = [MESHOPT, DRACO];
const GLB = 0x46546c67;

/**
 * Opens a file with everything that it refers to.
 *
 * @return json: its JSON as after unpacking: bufferViews lie in one buffer (`bin`), meshopt and Draco are gone with
 *         their names, images have no uri; bin; images: bytes of each; written: the JSON as it stands in the file;
 *         unpacked: indices of the accessors whose values came out of Draco; filtered: of the views whose values a
 *         filter of meshopt made, which decoders round differently
 */
export async function openPlain(file) {
  const bytes = readFileSync(file);
  const isGlb = bytes.length >= 4 && bytes.readUInt32LE(0) === GLB;
  const { json: written, bin } = isGlb ? parseGlb(bytes) : { json: JSON.parse(bytes.toString('utf8')) };
  const json = structuredClone(written);
  const buffers = (json.buffers ?? []).map(({ uri, byteLength }, i) =>
    (uri === undefined ? (i === 0 && bin) || new Uint8Array(byteLength) : resolveUri(uri, path.dirname(file))));
  const filtered = new Set((json.bufferViews ?? []).flatMap(({ extensions }, i) => (extensions?.[MESHOPT]?.filter ? [i] : [])));
  const views = [];
  for (const view of json.bufferViews ?? []) views.push(await readView(view, buffers));
  const images = (json.images ?? []).map(({ uri, bufferView }) =>
    (uri === undefined ? views[bufferView] : resolveUri(uri, path.dirname(file))));
  const unpacked = await unpackDraco(json, views);
  for (const image of json.images ?? []) delete image.uri;
  return { json: Object.assign(json, forgetUnpacked(json)), bin: joinViews(json, views), images, written, unpacked, filtered };
}

/** Bytes of a `data:` URI or of a file beside the glTF. */
function resolveUri(uri, folder) {
  const data = /^data:[^,]*?(;base64)?,(.*)$/s.exec(uri);
  const unescaped = (text) => text.replace(/%([0-9a-f]{2})/gi, (_, hex) => String.fromCharCode(parseInt(hex, 16)));  // bytes, no UTF-8
  if (data) return new Uint8Array(Buffer.from(unescaped(data[2]), data[1] ? 'base64' : 'latin1'));
  const file = path.join(folder, decodeURIComponent(uri));
  if (!existsSync(file)) throw new Error(`${uri} is not there`);
  return new Uint8Array(readFileSync(file));
}

async function readView(view, buffers) {
  const packed = view.extensions?.[MESHOPT];
  const { buffer, byteOffset = 0, byteLength } = packed ?? view;
  const bytes = buffers[buffer].slice(byteOffset, byteOffset + byteLength);
  if (!packed) return bytes;
  dropExtension(view, MESHOPT);
  const { MeshoptDecoder } = requireModule('meshoptimizer');
  await MeshoptDecoder.ready;
  const unpacked = new Uint8Array(packed.count * packed.byteStride);
  MeshoptDecoder.decodeGltfBuffer(unpacked, packed.count, packed.byteStride, bytes, packed.mode, packed.filter);
  return unpacked;
}

function dropExtension(object, name) {
  delete object.extensions[name];
  if (Object.keys(object.extensions).length === 0) delete object.extensions;
}

/** extensionsUsed and extensionsRequired without what was unpacked; undefined for a list that it emptied. */
function forgetUnpacked(json) {
  const lists = {};
  for (const list of ['extensionsUsed', 'extensionsRequired']) {
    if (!json[list]?.some((name) => UNPACKED.includes(name))) continue;
    lists[list] = json[list].filter((name) => !UNPACKED.includes(name));
    if (lists[list].length === 0) delete json[list], delete lists[list];
  }
  return lists;
}

/** Lays the views one after another and writes into `json` where. */
function joinViews(json, views) {
  let length = 0;
  const starts = views.map((view) => {
    const start = length;
    length += Math.ceil(view.length / 8) * 8;
    return start;
  });
  const bin = new Uint8Array(length);
  views.forEach((view, i) => {
    bin.set(view, starts[i]);
    Object.assign(json.bufferViews[i], { buffer: 0, byteOffset: starts[i], byteLength: view.length });
  });
  if (json.buffers) json.buffers = [{ byteLength: length }];
  return bin;
}

const COMPONENTS = {
  5120: { draco: 'DT_INT8', array: Int8Array }, 5121: { draco: 'DT_UINT8', array: Uint8Array },
  5122: { draco: 'DT_INT16', array: Int16Array }, 5123: { draco: 'DT_UINT16', array: Uint16Array },
  5125: { draco: 'DT_UINT32', array: Uint32Array }, 5126: { draco: 'DT_FLOAT32', array: Float32Array },
};

/** Gives every accessor of a Draco primitive a view of its own. @return those accessors */
async function unpackDraco(json, views) {
  const done = new Set();
  for (const primitive of (json.meshes ?? []).flatMap((mesh) => mesh.primitives)) {
    const packed = primitive.extensions?.[DRACO];
    if (!packed) continue;
    dropExtension(primitive, DRACO);
    const decoded = await decodeDraco(views[packed.bufferView], packed.attributes, primitive, json.accessors);
    for (const [index, bytes] of decoded) {
      json.bufferViews.push({ buffer: 0 });
      json.accessors[index].bufferView = views.push(bytes) - 1;
      done.add(index);
    }
  }
  return done;
}

let dracoModule;

async function decodeDraco(bytes, attributes, primitive, accessors) {
  dracoModule ??= await requireModule('draco3dgltf').createDecoderModule({});
  const decoder = new dracoModule.Decoder();
  const mesh = new dracoModule.Mesh();
  const status = decoder.DecodeArrayToMesh(new Int8Array(bytes.buffer, bytes.byteOffset, bytes.length), bytes.length, mesh);
  if (!status.ok()) throw new Error(`Draco: ${status.error_msg()}`);
  const read = (size, take) => {
    const at = dracoModule._malloc(size);
    take(at);
    const copy = dracoModule.HEAPU8.slice(at, at + size);
    dracoModule._free(at);
    return copy;
  };
  const decoded = Object.entries(attributes).map(([name, id]) => {
    const accessor = accessors[primitive.attributes[name]];
    const { draco, array } = COMPONENTS[accessor.componentType];
    const attribute = decoder.GetAttributeByUniqueId(mesh, id);
    const size = mesh.num_points() * attribute.num_components() * array.BYTES_PER_ELEMENT;
    return [primitive.attributes[name], read(size, (at) =>
      decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, dracoModule[draco], size, at))];
  });
  const size = mesh.num_faces() * 12;
  const corners = read(size, (at) => decoder.GetTrianglesUInt32Array(mesh, size, at));
  const { array } = COMPONENTS[accessors[primitive.indices].componentType];
  decoded.push([primitive.indices, new Uint8Array(array.from(new Uint32Array(corners.buffer)).buffer)]);
  return decoded;
}
