// Nodes, meshes, skins, targets, animations, extensions of a source.
import { FLOAT, POSITIONS, UBYTE, addAccessor, all, set } from './good.mjs';

const P = '#/meshes/0/primitives/0', INVALID = '[gltf.invalid]', BAD = '[gltf.bad-value]';

const nodes = {
  'no mesh': [set('nodes.0.mesh', undefined), '[gltf.no-mesh]'],
  'no nodes': [all(set('nodes', []), set('scenes', [{ nodes: [] }])), '[gltf.no-mesh]'],
  'empty mesh': [set('meshes.0.primitives', []), 'gltf.'],
  'node without its mesh': [set('nodes.0.mesh', 3), '#/nodes/0/mesh', INVALID],
  'two mesh nodes': [(g) => { g.nodes.push({ mesh: 0 }); g.scenes[0].nodes.push(1); }, '#/nodes/1', '[gltf.several-meshes]'],
  'missing scene': [set('scene', 3), '#/scene', INVALID],
  'scene -1': [set('scene', -1), '#/scene', '[gltf.out-of-range]'],
  'scene of a missing node': [set('scenes.0.nodes', [9]), INVALID],
  'scene of a node twice': [set('scenes.0.nodes', [0, 0]), '/nodes/0', INVALID],
  'missing child': [set('nodes.0.children', [99]), INVALID],
  'node cycle': [(g) => { g.nodes = [{ children: [1] }, { children: [0], mesh: 0 }]; }, '/nodes/0', INVALID],
  'node that is its own child': [set('nodes.0.children', [0]), '/nodes/0', INVALID],
  'cycle below the scene': [(g) => { g.nodes = [{ mesh: 0, children: [1] }, { children: [2] }, { children: [1] }]; }, '/nodes/1', INVALID],
  'node with two parents': [(g) => { g.nodes = [{ children: [2] }, { children: [2] }, { mesh: 0 }]; g.scenes[0].nodes = [0, 1]; }, '/nodes/2', INVALID],
  'matrix of 15': [set('nodes.0.matrix', new Array(15).fill(1)), '#/nodes/0/matrix', BAD],
  'matrix of text': [set('nodes.0.matrix', new Array(16).fill('1')), '#/nodes/0/matrix/0', '[gltf.wrong-type]'],
  'matrix of zeros': [set('nodes.0.matrix', new Array(16).fill(0)), '#/nodes/0', 'gltf.'],
  'scale of 2': [set('nodes.0.scale', [1, 1]), '#/nodes/0/scale', BAD],
  'rotation of 3': [set('nodes.0.rotation', [0, 0, 1]), '#/nodes/0/rotation', BAD],
  'translation of 4': [set('nodes.0.translation', [0, 0, 1, 1]), '#/nodes/0/translation', BAD],
  'astronomic scale': [set('nodes.0.scale', [1e200, 1e200, 1e200]), '#/nodes/0', '[gltf.extreme-size]'],
  'astronomic place': [set('nodes.0.translation', [1e300, 0, 0]), '[gltf.extreme-size]'],
  'scales that overflow together': [(g) => {
    g.nodes = [{ scale: [1e300, 1, 1], children: [1] }, { scale: [1e300, 1, 1], mesh: 0 }];
  }, '/nodes/1', '[gltf.not-finite]'],
  'flattening node': [set('nodes.0.scale', [1, 0, 1]), '#/nodes/0', '[gltf.singular-transform]'],
};

const primitives = {
  'text for targets': [set('meshes.0.primitives.0.targets', 'x'), `${P}/targets`, '[gltf.wrong-type]'],
  'number for a target': [set('meshes.0.primitives.0.targets', [4]), `${P}/targets/0`, '[gltf.wrong-type]'],
  'text for a mode': [set('meshes.0.primitives.0.mode', '4'), `${P}/mode`, '[gltf.wrong-type]'],
  'mode 7': [set('meshes.0.primitives.0.mode', 7), `${P}/mode`, '[gltf.out-of-range]'],
  'mode 2^31': [set('meshes.0.primitives.0.mode', 2 ** 31), `${P}/mode`, '[gltf.out-of-range]'],
  'points': [set('meshes.0.primitives.0.mode', 0), `${P}/mode`, '[gltf.unsupported-primitive]'],
  'lines': [set('meshes.0.primitives.0.mode', 1), `${P}/mode`, '[gltf.unsupported-primitive]'],
  'text for attributes': [set('meshes.0.primitives.0.attributes', 'POSITION'), `${P}/attributes`, '[gltf.wrong-type]'],
  'text for a position': [set('meshes.0.primitives.0.attributes.POSITION', '0'), `${P}/attributes/POSITION`, '[gltf.wrong-type]'],
  'no positions': [set('meshes.0.primitives.0.attributes', { NORMAL: 1 }), 'POSITION', '[gltf.unsupported-primitive]'],
  'no attributes': [set('meshes.0.primitives.0.attributes', undefined), `${P}`, '[gltf.missing-field]'],
  'emissive factor of two': [set('materials', [{ emissiveFactor: [1, 1] }]), '#/materials/0/emissiveFactor', BAD],
  'normals on one primitive only': [(g) => {
    g.meshes[0].primitives.push({ attributes: { POSITION: 0 }, indices: 2 });
  }, '[gltf.mixed-normals]'],
};

/** What refers to a thing that is not there, though the shape needs none of it. */
const dangling = {
  'missing material': [set('meshes.0.primitives.0.material', 1), `${P}/material`, INVALID, 'the file has 0'],
  'missing texture': [set('materials', [{ pbrMetallicRoughness: { baseColorTexture: { index: 2 } } }]),
    '#/materials/0/pbrMetallicRoughness/baseColorTexture/index', INVALID],
  'missing image': [set('textures', [{ source: 0 }]), '#/textures/0/source', INVALID],
  'missing picture of an extension': [(g) => { g.textures = [{ extensions: { EXT_texture_webp: { source: 3 } } }]; },
    '#/textures/0/extensions/EXT_texture_webp/source', INVALID],
  'an empty list of views': [all(set('bufferViews', []), set('buffers', undefined)), '#/accessors/0/bufferView', INVALID],
  'missing texture sampler': [set('textures', [{ sampler: 7 }]), '#/textures/0/sampler', INVALID],
  'texture -1': [set('materials', [{ emissiveTexture: { index: -1 } }]), '#/materials/0/emissiveTexture/index', 'gltf.'],
  'missing sampler of a node that is not morphed': [(g) => {
    g.nodes.push({});
    g.animations = [{ samplers: [], channels: [{ sampler: 0, target: { node: 1, path: 'scale' } }] }];
  }, '#/animations/0/channels/0/sampler', INVALID],
  'missing camera': [set('nodes.0.camera', 0), '#/nodes/0/camera', INVALID],
  'missing colours of a target': [set('meshes.0.primitives.0.targets', [{ POSITION: 0, COLOR_0: 44 }]), `${P}/targets/0/COLOR_0`, INVALID],
  'another mesh without its points': [(g) => g.meshes.push({ primitives: [{ attributes: { POSITION: 99 } }] }),
    '#/meshes/1/primitives/0/attributes/POSITION', INVALID],
};

/** A target whose displacements are `values`. */
const target = (values) => (gltf) => {
  gltf.meshes[0].primitives[0].targets = [{ POSITION: addAccessor(gltf, values, 'VEC3', FLOAT) }];
};

const targetCases = {
  'target of fewer vertices': [target(new Float32Array(9)), `${P}/targets/0/POSITION`, '[gltf.accessor]'],
  'target of more vertices': [target(new Float32Array(60)), `${P}/targets/0/POSITION`, '[gltf.accessor]'],
  'target not a number': [target(new Float32Array(18).fill(NaN)), `${P}/targets/0/POSITION`, '[gltf.not-finite]'],
  'target of a missing accessor': [set('meshes.0.primitives.0.targets', [{ POSITION: 40 }]), `${P}/targets/0/POSITION`, INVALID],
  'target of bytes': [(g) => {
    g.meshes[0].primitives[0].targets = [{ POSITION: addAccessor(g, new Uint8Array(24), 'VEC4', UBYTE) }];
  }, `${P}/targets/0/POSITION`, 'gltf.'],
  'primitives with different targets': [(g) => {
    g.meshes[0].primitives.push(structuredClone(g.meshes[0].primitives[0]));
    g.meshes[0].primitives[0].targets = [{ POSITION: 0 }];
  }, '#/meshes/0/primitives/1', INVALID],
};

const IDENTITY = Float32Array.from({ length: 16 }, (_, i) => (i % 5 ? 0 : 1));

/** A skin of one joint; `change(gltf, skin)` spoils it. */
const skin = (change) => (gltf) => {
  gltf.nodes = [{ mesh: 0, skin: 0 }, {}];
  gltf.scenes[0].nodes = [0, 1];
  const { attributes } = gltf.meshes[0].primitives[0];
  attributes.JOINTS_0 = addAccessor(gltf, new Uint8Array(24), 'VEC4', UBYTE);
  attributes.WEIGHTS_0 = addAccessor(gltf, Float32Array.from({ length: 24 }, (_, i) => (i % 4 ? 0 : 1)), 'VEC4', FLOAT);
  gltf.skins = [{ joints: [1], inverseBindMatrices: addAccessor(gltf, IDENTITY, 'MAT4', FLOAT) }];
  const input = addAccessor(gltf, Float32Array.of(0, 1), 'SCALAR', FLOAT);
  const output = addAccessor(gltf, new Float32Array(6), 'VEC3', FLOAT);
  gltf.animations = [{ samplers: [{ input, output }], channels: [{ sampler: 0, target: { node: 1, path: 'translation' } }] }];
  change(gltf, gltf.skins[0]);
};

const skinCases = {
  'missing skin': [skin((g) => { g.nodes[0].skin = 4; }), '#/nodes/0/skin', INVALID],
  'skin without joints': [skin((g, s) => { delete s.joints; }), '#/skins/0', 'gltf.'],
  'skin of no joints': [skin((g, s) => { s.joints = []; }), '#/skins/0', 'gltf.'],
  'skin of a missing joint': [skin((g, s) => { s.joints = [17]; }), '#/skins/0/joints/0', INVALID],
  'text for joints': [skin((g, s) => { s.joints = 'x'; }), '#/skins/0/joints', '[gltf.wrong-type]'],
  'skin of joint -1': [skin((g, s) => { s.joints = [-1]; }), '#/skins/0/joints/0', '[gltf.out-of-range]'],
  'skin with fewer bind matrices': [skin((g, s) => { s.joints = [1, 0]; }), '#/skins/0/inverseBindMatrices', '[gltf.accessor]'],
  'bind matrices of vectors': [skin((g, s) => { s.inverseBindMatrices = 0; }), '#/skins/0/inverseBindMatrices', '[gltf.accessor]'],
  'missing bind matrices': [skin((g, s) => { s.inverseBindMatrices = 99; }), '#/skins/0/inverseBindMatrices', INVALID],
  'bind matrix not a number': [skin((g, s) => {
    s.inverseBindMatrices = addAccessor(g, new Float32Array(16).fill(NaN), 'MAT4', FLOAT);
  }), '#/skins/0/inverseBindMatrices', '[gltf.not-finite]'],
  'joint out of range': [skin((g) => {
    g.meshes[0].primitives[0].attributes.JOINTS_0 = addAccessor(g, new Uint8Array(24).fill(200), 'VEC4', UBYTE);
  }), `${P}/attributes`, '[gltf.accessor]'],
  'weight not a number': [skin((g) => {
    g.meshes[0].primitives[0].attributes.WEIGHTS_0 = addAccessor(g, new Float32Array(24).fill(NaN), 'VEC4', FLOAT);
  }), `${P}/attributes/WEIGHTS_0`, '[gltf.not-finite]'],
  'fewer weights': [skin((g) => {
    g.meshes[0].primitives[0].attributes.WEIGHTS_0 = addAccessor(g, new Float32Array(8), 'VEC4', FLOAT);
  }), `${P}/attributes/WEIGHTS_0`, '[gltf.accessor]'],
  'joints without weights': [skin((g) => { delete g.meshes[0].primitives[0].attributes.WEIGHTS_0; }), `${P}/attributes`, 'gltf.'],
};

/** A target and a weights animation with keys at `times`; `change(gltf, sampler)` spoils it. */
const animated = (change, times = [0, 1], weights = [0, 1]) => (gltf) => {
  gltf.meshes[0].primitives[0].targets = [{ POSITION: addAccessor(gltf, new Float32Array(POSITIONS.length / 4), 'VEC3', FLOAT) }];
  const sampler = {
    input: addAccessor(gltf, Float32Array.from(times), 'SCALAR', FLOAT),
    output: addAccessor(gltf, Float32Array.from(weights), 'SCALAR', FLOAT),
  };
  gltf.animations = [{ samplers: [sampler], channels: [{ sampler: 0, target: { node: 0, path: 'weights' } }] }];
  change(gltf, sampler);
};
const A = '#/animations/0/samplers/0';
const same = () => {};

/** What stays in the file that is written, with numbers for the new targets. */
const animations = {
  'text for channels': [animated((g) => { g.animations[0].channels = 'x'; }), '#/animations/0', 'gltf.'],
  'number for a channel': [animated((g) => { g.animations[0].channels = [3]; }), '#/animations/0', 'gltf.'],
  'number for a sampler': [animated((g) => { g.animations[0].samplers = [3]; }), '#/animations/0', 'gltf.'],
  'animation without samplers': [animated((g) => { delete g.animations[0].samplers; }), '#/animations/0', 'gltf.'],
  'animation without channels': [animated((g) => { delete g.animations[0].channels; }), '#/animations/0', 'gltf.'],
  'channel without a sampler': [animated((g) => { delete g.animations[0].channels[0].sampler; }), '#/animations/0', 'gltf.'],
  'channel without a target': [animated((g) => { delete g.animations[0].channels[0].target; }), '#/animations/0', 'gltf.'],
  'channel without a path': [animated((g) => { delete g.animations[0].channels[0].target.path; }), '#/animations/0', 'gltf.'],
  'text for a channel\'s sampler': [animated((g) => { g.animations[0].channels[0].sampler = 'x'; }), '#/animations/0', 'gltf.'],
  'text for a channel\'s node': [animated((g) => { g.animations[0].channels[0].target.node = 'x'; }), '#/animations/0', 'gltf.'],
  'sampler of four billion': [animated((g) => { g.animations[0].channels[0].sampler = 4294967295; }), '#/animations/0', 'gltf.'],
  'missing sampler': [animated((g) => { g.animations[0].channels[0].sampler = 8; }), '#/animations/0/channels/0/sampler', INVALID],
  'sampler -1': [animated((g) => { g.animations[0].channels[0].sampler = -1; }), '#/animations/0', 'gltf.'],
  'text for a key': [animated((g, s) => { s.input = 'x'; }), '#/animations/0', 'gltf.'],
  'sampler without an output': [animated((g, s) => { delete s.output; }), '#/animations/0', 'gltf.'],
  'fewer weights than keys, baked': [animated(same, [0, 1], [0]), `${A}/output`, '[gltf.accessor]'],
  'key time not a number, baked': [animated(same, [0, NaN]), `${A}/input`, '[gltf.not-finite]'],
};

export const baked = { ...nodes, ...primitives, ...dangling, ...targetCases, ...animations };

const MOMENT = { animation: { time: 0.5 } };
const chooses = (choice, ...texts) => [choice, animated(same), ...texts];

/** Sources of which a recipe chooses a part or a moment: what it chooses, then as above. */
export const chosen = {
  ...Object.fromEntries(Object.entries(skinCases).map(([name, definition]) => [name, [MOMENT, ...definition]])),
  'moment of no animation': [MOMENT, same, '[gltf.no-such-animation]'],
  'missing animation': chooses({ animation: { name: 'walk', time: 0 } }, 'walk', '[gltf.no-such-animation]'),
  'animation 7': chooses({ animation: { name: 7, time: 0 } }, '[gltf.no-such-animation]'),
  'chosen node without a mesh': [{ node: 1 }, (g) => { g.nodes.push({}); }, '#/nodes/1', '[gltf.no-mesh]'],
  'missing chosen node': chooses({ node: 'hand' }, 'hand', '[gltf.no-such-node]'),
  'node 16 million': chooses({ node: 16777216 }, '[gltf.no-such-node]'),
  'missing chosen mesh': chooses({ mesh: 'hand' }, 'hand', '[gltf.no-such-mesh]'),
  'missing chosen target': chooses({ target: 'smile' }, 'smile', '[gltf.no-such-target]'),
  'target 9': chooses({ target: 9 }, '[gltf.no-such-target]'),
  'moment of a key time not a number': [MOMENT, animated(same, [0, NaN]), `${A}/input`, '[gltf.not-finite]'],
  'moment of key times that fall': [MOMENT, animated(same, [1, 0]), `${A}/input`, '[gltf.accessor]'],
  'moment of fewer weights than keys': [MOMENT, animated(same, [0, 1], [0]), `${A}/output`, '[gltf.accessor]'],
  'moment of a missing sampler': [MOMENT, animated((g) => { g.animations[0].channels[0].sampler = 8; }), '#/animations/0', INVALID],
};

/** What `preview` reads. */
export const previewed = {
  'key time not a number': [animated(same, [0, NaN]), `${A}/input`, '[gltf.not-finite]'],
  'infinite key time': [animated(same, [0, Infinity]), `${A}/input`, '[gltf.not-finite]'],
  'key times that fall': [animated(same, [1, 0]), `${A}/input`, '[gltf.accessor]'],
  'key times that repeat': [animated(same, [1, 1]), `${A}/input`, '[gltf.accessor]'],
  'negative key time': [animated(same, [-1, 1]), `${A}/input`, '[gltf.accessor]'],
  'weight of a key not a number': [animated(same, [0, 1], [0, NaN]), `${A}/output`, '[gltf.not-finite]'],
  'more weights than keys': [animated(same, [0, 1], [0, 1, 0]), `${A}/output`, '[gltf.accessor]'],
  'fewer weights than keys': [animated(same, [0, 1], [0]), `${A}/output`, '[gltf.accessor]'],
  'keys of a missing accessor': [animated((g, s) => { s.input = 55; }), `${A}/input`, INVALID],
  'keys of vectors': [animated((g, s) => { s.input = 0; }), `${A}/input`, '[gltf.accessor]'],
  'unknown interpolation': [animated((g, s) => { s.interpolation = 'MAGIC'; }), `${A}/interpolation`, 'gltf.'],
  'fewer colours': [(g) => {
    g.meshes[0].primitives[0].attributes.COLOR_0 = addAccessor(g, new Float32Array(9), 'VEC3', FLOAT);
  }, `${P}/attributes/COLOR_0`, '[gltf.accessor]'],
  'colour not a number': [(g) => {
    g.meshes[0].primitives[0].attributes.COLOR_0 = addAccessor(g, new Float32Array(18).fill(NaN), 'VEC3', FLOAT);
  }, `${P}/attributes/COLOR_0`, '[gltf.not-finite]'],
};
