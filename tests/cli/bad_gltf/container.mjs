// The .glb around the glTF, its JSON, and what its URIs name.
import { binaryOctahedron, container, dataUri, jsonChunk, set } from './good.mjs';

const text = (change) => (gltf) => change(JSON.stringify(gltf));
const KINDS = ['scenes', 'nodes', 'meshes', 'accessors', 'bufferViews', 'buffers', 'images', 'textures', 'materials', 'skins', 'animations'];

/** Each list of a glTF as text, and with a number for an entry. */
const wrongKinds = Object.fromEntries(KINDS.flatMap((kind) => [
  [`text for ${kind}`, [set(kind, 'x'), `#/${kind}`, '[gltf.wrong-type]']],
  [`number in ${kind}`, [set(kind, [7]), `#/${kind}/0`, '[gltf.wrong-type]']],
]));

const glb = {
  'glb of container version 1': [(g) => container([jsonChunk(g)], { version: 1 }), '[gltf.version]'],
  'glb cut off': [(g) => container([jsonChunk(g)]).subarray(0, 300), '[gltf.truncated]'],
  'glb of eight bytes': [(g) => container([jsonChunk(g)]).subarray(0, 8), '[gltf.truncated]'],
  'glb of four bytes': [() => 'glTF', '[gltf.truncated]'],
  'glb without JSON': [(g) => container([['BIN\0', jsonChunk(g)[1]]]), '[gltf.truncated]'],
  'glb with BIN first': [(g) => { const { json, bin } = binaryOctahedron(g); return container([bin, json]); }, '[gltf.truncated]'],
  'glb with an unknown chunk first': [(g) => container([['TEXT', Buffer.alloc(8)], jsonChunk(g)]), '[gltf.truncated]'],
  'glb with two JSON chunks': [(g) => container([jsonChunk(g), jsonChunk(g)]), '[gltf.invalid]'],
  'glb with an empty JSON chunk': [() => container([['JSON', Buffer.alloc(0)]]), '[gltf.json-syntax]'],
  'glb with zeros for JSON': [() => container([['JSON', Buffer.alloc(64)]]), '[gltf.json-syntax]'],
  'glb that says 0 bytes': [(g) => container([jsonChunk(g)], { length: 0 }), '[gltf.truncated]'],
  'glb that says 4 GB': [(g) => container([jsonChunk(g)], { length: 0xffffffff }), '[gltf.truncated]'],
  'JSON chunk of 4 GB': [(g) => container([['JSON', jsonChunk(g)[1], 0xffffffff]]), '[gltf.truncated]'],
  'JSON chunk longer by 4': [(g) => container([['JSON', jsonChunk(g)[1], jsonChunk(g)[1].length + 4]]), '[gltf.truncated]'],
  'BIN chunk of 4 GB': [(g) => { const { json, bin } = binaryOctahedron(g); return container([json, [...bin, 0xfffffffc]]); }, '[gltf.truncated]'],
  'BIN chunk longer by 4': [(g) => { const { json, bin } = binaryOctahedron(g); return container([json, [...bin, bin[1].length + 4]]); }, '[gltf.truncated]'],
  'BIN chunk longer by 8': [(g) => { const { json, bin } = binaryOctahedron(g); return container([json, [...bin, bin[1].length + 8]]); }, '[gltf.truncated]'],
  'BIN chunk shorter than its buffer': [(g) => { const { json, bin } = binaryOctahedron(g); return container([json, ['BIN\0', bin[1].subarray(0, 96)]]); }, '#/buffers/0', '[gltf.invalid]'],
  'BIN chunk of no bytes': [(g) => container([binaryOctahedron(g).json, ['BIN\0', Buffer.alloc(0)]]), '#/buffers/0', '[gltf.invalid]'],
  'BIN chunk missing': [(g) => container([binaryOctahedron(g).json]), '#/buffers/0', '[gltf.invalid]'],
  'three bytes after the chunks': [(g) => Buffer.concat([container([jsonChunk(g)]), Buffer.alloc(3)]), '[gltf.truncated]'],
};

const json = {
  'text file': [() => 'solid cube\nendsolid', '[gltf.not-gltf]', 'glTF 2.0'],
  'empty file': [() => '', '[gltf.not-gltf]'],
  'only spaces, 64 MB': [() => Buffer.alloc(64e6, ' '), '[gltf.not-gltf]'],
  'a bracket and 64 MB of spaces': [() => Buffer.concat([Buffer.from('{'), Buffer.alloc(64e6, ' ')]), '[gltf.json-syntax]'],
  'byte order mark': [text((t) => `\ufeff${t}`), '[gltf.not-gltf]', 'byte order mark'],
  'UTF-16': [text((t) => Buffer.from(t, 'utf16le')), 'gltf.'],
  'broken JSON': [() => '{"asset": {"version": "2.0"}', '[gltf.json-syntax]'],
  'other JSON': [() => '{"name": "x"}', '#/asset/version', '[gltf.not-gltf]'],
  'a list for a glTF': [() => '[1, 2]', '[gltf.not-gltf]'],
  'text for an asset': [set('asset', '2.0'), '#/asset', 'gltf.'],
  'number for a version': [set('asset.version', 2), '#/asset/version', '[gltf.version]', 'is a string'],
  'glTF 1': [set('asset.version', '1.0'), '#/asset/version', '[gltf.version]', '"1.0"'],
  'glTF 2.0 and a NUL': [set('asset.version', '2.0\0'), '#/asset/version', '[gltf.version]'],
  'deep lists': [set('extras', JSON.parse('['.repeat(3000) + ']'.repeat(3000))), '[gltf.json-too-deep]'],
  'a million brackets': [() => `{"extras":${'['.repeat(1e6)}`, '[gltf.json-too-deep]'],
  'a million braces': [() => '{"a":'.repeat(1e6), '[gltf.json-too-deep]'],
  'field that stands twice': [text((t) => t.replace('"scene":0', '"scene":0,"meshes":[]')), '#/meshes', '[gltf.json-duplicate-key]'],
  'a field 100,000 times': [text((t) => t.replace('"scene":0', Array(1e5).fill('"scene":0').join())), '#/scene', '[gltf.json-duplicate-key]'],
  'NaN in the JSON': [text((t) => t.replace('"scene":0', '"scene":NaN')), '[gltf.json-syntax]', 'NaN'],
  'Infinity in the JSON': [text((t) => t.replace('"scene":0', '"scene":-Infinity')), '[gltf.json-syntax]'],
  'number beyond double': [text((t) => t.replace('"scene":0', '"scene":1e999')), '[gltf.json-syntax]'],
  'number of 400 digits': [text((t) => t.replace('"scene":0', `"scene":${'9'.repeat(400)}`)), '[gltf.json-syntax]'],
  'number of 100 digits': [text((t) => t.replace('"scene":0', `"scene":${'9'.repeat(100)}`)), '#/scene', 'gltf.'],
  'bell in a name': [text((t) => t.replace('"scene":0', '"scene":0,"extras":"\u0007"')), '[gltf.json-syntax]'],
  'NUL in the JSON': [text((t) => t.replace('"scene":0', '"scene":\0')), '[gltf.json-syntax]'],
  'no UTF-8': [text((t) => Buffer.from(t.replace('"scene":0', '"extras":"\xe4"'), 'latin1')), '[gltf.json-syntax]', 'UTF-8'],
  'half a surrogate pair': [text((t) => t.replace('"scene":0', '"extras":"\\ud800"')), '[gltf.json-syntax]'],
  'required extension': [set('extensionsRequired', ['EXT_from_the_future']),
    '#/extensionsRequired/0', 'EXT_from_the_future', '[gltf.unsupported-extension]'],
  'required number': [set('extensionsRequired', [7]), '#/extensionsRequired/0', '[gltf.wrong-type]'],
  'required extension with a terminal sequence': [set('extensionsRequired', ['\u001b[2J\u0007']),
    '#/extensionsRequired/0', '[gltf.unsupported-extension]'],
  'ten thousand problems': [(g) => { g.nodes = new Array(10000).fill(3); }, '#/nodes/0', '[gltf.wrong-type]'],
  ...wrongKinds,
};

const outside = (uri) => [set('buffers.0.uri', uri), '#/buffers/0/uri', '[gltf.outside-folder]'];
const missing = (uri) => [set('buffers.0.uri', uri), '#/buffers/0/uri', '[gltf.missing-file]'];

const uris = {
  'buffer outside the folder': outside('../../../../etc/passwd'),
  'escaped way out': outside('%2e%2e/secret.bin'),
  'wholly escaped way out': outside('%2E%2E%2Fsecret.bin'),
  'way out behind a folder': outside('a/b/../../../secret.bin'),
  'way out behind a dot': outside('./../secret.bin'),
  'absolute buffer': outside('/etc/passwd'),
  'escaped absolute buffer': outside('%2fetc%2fpasswd'),
  'two slashes': outside('//example.org/a.bin'),
  'buffer of the web': outside('https://example.org/a.bin'),
  'file URI': outside('file:///etc/passwd'),
  'file URI in capitals': outside('FILE:/etc/passwd'),
  'escaped file URI': outside('file%3a%2f%2f%2fetc/passwd'),
  'a letter of a drive': outside('C:\\secret.bin'),
  'device': outside('/dev/zero'),
  'memory of the process': outside('/proc/self/environ'),
  'link out of the folder': outside('link.bin'),
  'linked folder': outside('linked/secret.bin'),
  'NUL in a URI': outside('good.bin\0/../../secret.bin'),
  'escaped NUL': outside('good.bin%00'),
  'empty URI': outside(''),
  'image of a long name': [set('images', [{ uri: `${'i'.repeat(300)}.png` }]), '#/images/0/uri', '[gltf.missing-file]', 'long name'],
  'image outside the folder': [set('images', [{ uri: '../secret.png' }]), '#/images/0/uri', '[gltf.outside-folder]'],
  'missing buffer': missing('gone.bin'),
  'backslashes': missing('..\\secret.bin'),
  'twice escaped way out': missing('%252e%252e/secret.bin'),
  'home of the user': missing('~/.bashrc'),
  'folder for a buffer': missing('.'),
  'pipe for a buffer': missing('pipe.bin'),
  'file shorter than its buffer': [set('buffers.0.uri', 'short.bin'), '#/buffers/0', '[gltf.invalid]'],
  'name of 5000 letters': [set('buffers.0.uri', 'x'.repeat(5000)), 'gltf.'],
  'data URI without bytes': [set('buffers.0.uri', 'data:application/octet-stream;base64,'), '#/buffers/0', '[gltf.invalid]'],
  'data URI without a comma': [set('buffers.0.uri', 'data:application/octet-stream;base64'), '#/buffers/0', '[gltf.invalid]'],
  'data URI of plain text': [set('buffers.0.uri', 'data:text/plain,hello'), '#/buffers/0', '[gltf.invalid]'],
  'data URI of bad base64': [set('buffers.0.uri', 'data:application/octet-stream;base64,!!!!????'), '#/buffers/0', '[gltf.invalid]'],
  'data URI of half base64': [set('buffers.0.uri', 'data:application/octet-stream;base64,AAAA!AAA'), '#/buffers/0', '[gltf.invalid]'],
  'data URI of base64 cut short': [set('buffers.0.uri', 'data:application/octet-stream;base64,AAAAA'), '#/buffers/0/uri', '[gltf.invalid]'],
  'data URI of a broken escape': [set('buffers.0.uri', `data:,${'%00'.repeat(191)}%0`), '#/buffers/0/uri', '[gltf.invalid]'],
  'image of no bytes': [set('images', [{ uri: 'data:image/webp;base64,' }]), '#/images/0', '[gltf.invalid]'],
  'image of an empty file': [set('images', [{ uri: 'empty.jpg' }]), '#/images/0', '[gltf.invalid]'],
  'image with URI and view': [set('images', [{ uri: 'empty.jpg', bufferView: 0 }]), '#/images/0', '[gltf.invalid]'],
  'second buffer without a URI': [(g) => { g.buffers.push({ byteLength: 4 }); }, '#/buffers/1', '[gltf.invalid]'],
  'data URI shorter than its buffer': [set('buffers.0.uri', dataUri(Buffer.alloc(8))), '#/buffers/0', '[gltf.invalid]'],
  'only data:': [set('buffers.0.uri', 'data:'), '#/buffers/0', '[gltf.invalid]'],
};

export const baked = { ...glb, ...json, ...uris };

