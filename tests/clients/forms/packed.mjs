// Compressed forms, by the npm encoders.
import { requireModule } from '../support.mjs';
import * as gltf from './document.mjs';

const MESHOPT = 'EXT_meshopt_compression';
const DRACO = 'KHR_draco_mesh_compression';

/**
 * Rows as an accessor whose view is packed by meshopt.
 *
 * @param layout  componentType, stride, mode ('ATTRIBUTES' | 'TRIANGLES' | 'INDICES'), filter, target; `fallback` is what
 *                the view's own buffer is: an index, or undefined to store the plain bytes too
 */
export async function putMeshopt(document, rows, { componentType, stride, mode, filter, target, fallback, ...fields }) {
  const { MeshoptEncoder } = requireModule('meshoptimizer');
  await MeshoptEncoder.ready;
  const bytes = filter === 'OCTAHEDRAL'
    ? MeshoptEncoder.encodeFilterOct(Float32Array.from(rows.flatMap((row) => [...row, 0])), rows.length, stride, 8)
    : gltf.packRows(rows, componentType, stride);
  const packed = MeshoptEncoder.encodeGltfBuffer(bytes, rows.length, stride, mode, 0);
  const at = gltf.putView(document, packed);
  const { byteOffset, byteLength } = document.json.bufferViews.pop();
  const extension = { buffer: 0, byteOffset, byteLength, byteStride: stride, count: rows.length, mode, ...(filter && { filter }) };
  const view = { target, ...(target === gltf.VERTICES && { byteStride: stride }), extensions: { [MESHOPT]: extension } };
  if (fallback === undefined) gltf.putView(document, bytes, view);
  else document.json.bufferViews.push({ buffer: fallback.buffer, byteOffset: fallback.take(bytes.length),
    byteLength: bytes.length, ...view });
  return gltf.describeAccessor(document, rows, componentType, { bufferView: at, ...fields.accessor }, fields.bounds);
}

/**
 * A primitive packed by Draco; its accessors tell the bounds of what went in, as exporters do.
 *
 * @param withPlain  whether the accessors have bytes besides, of the same number of vertices in any order
 */
export async function putDraco(document, shape, { method = 'MESH_EDGEBREAKER_ENCODING', withPlain = false } = {}) {
  const draco = await requireModule('draco3dgltf').createEncoderModule({});
  const [encoder, builder, mesh] = [new draco.Encoder(), new draco.MeshBuilder(), new draco.Mesh()];
  builder.AddFacesToMesh(mesh, shape.triangles.length, Uint32Array.from(shape.triangles.flat()));
  const attributes = {};
  for (const [name, kind, rows] of [['POSITION', 'POSITION', shape.points], ['NORMAL', 'NORMAL', shape.normals],
    ['TEXCOORD_0', 'TEX_COORD', shape.uvs]])
    attributes[name] =
      builder.AddFloatAttributeToMesh(mesh, draco[kind], rows.length, rows[0].length, Float32Array.from(rows.flat()));
  encoder.SetEncodingMethod(draco[method]);
  encoder.SetSpeedOptions(5, 5);
  encoder.SetTrackEncodedProperties(true);
  encoder.SetAttributeQuantization(draco.POSITION, 14);
  encoder.SetAttributeQuantization(draco.NORMAL, 10);
  encoder.SetAttributeQuantization(draco.TEX_COORD, 12);
  const out = new draco.DracoInt8Array();
  const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
  const bytes = Uint8Array.from({ length }, (_, i) => out.GetValue(i));
  const count = encoder.GetNumberOfEncodedPoints();
  const putPlain = (index, rows, componentType, target) => {
    const stride = rows[0].length * (componentType === gltf.FLOAT ? 4 : 2);
    document.json.accessors[index].bufferView = gltf.putView(document, gltf.packRows(rows, componentType, stride), { target });
  };
  const describe = (rows, bounds) => {
    const index = gltf.describeAccessor(document, rows, gltf.FLOAT, {}, bounds);
    document.json.accessors[index].count = count;
    if (withPlain) putPlain(index, Array.from({ length: count }, (_, i) => rows[i % rows.length]), gltf.FLOAT, gltf.VERTICES);
    return index;
  };
  const primitive = {
    attributes: { POSITION: describe(shape.points, true), NORMAL: describe(shape.normals), TEXCOORD_0: describe(shape.uvs) },
    indices: gltf.describeAccessor(document, shape.triangles.flat().map((i) => [i]), gltf.UNSIGNED_SHORT, {}),
    extensions: { [DRACO]: { bufferView: gltf.putView(document, bytes), attributes } },
  };
  const corners = shape.triangles.flat().map((i) => [i]);
  if (withPlain) putPlain(primitive.indices, corners, gltf.UNSIGNED_SHORT, gltf.INDICES);
  document.json.extensionsUsed = [DRACO];
  document.json.extensionsRequired = [DRACO];
  return primitive;
}
