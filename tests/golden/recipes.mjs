import { deflateSync } from 'node:zlib';
import { png } from '../cli/bad_gltf/pictures.mjs';

// One small recipe for each kind of region, state, derived source and timing, over the shapes of tests/clients.

const SOURCES = { orb: 'orb.glb', long: 'orb-long.glb', nosed: 'orb-nose.glb' };
const circle = (z, radius) => [0, 1, 2, 3, 4].map((k) =>
  ({ position: [radius * Math.cos(1.2566370614359172 * k + 0.1), radius * Math.sin(1.2566370614359172 * k + 0.1), z] }));
const ball = (at, inner, outer) => ({ ball: { on: 'orb', at, inner, outer } });

/** A recipe whose only track goes to `long` in the region `r`. */
const of = (r, more = {}) => ({
  version: 1, name: 'golden', sources: SOURCES, regions: { r, ...more.regions },
  timeline: { fps: 4, tracks: [{ region: 'r', to: 'long', begin: 0, end: 1, ease: 'linear' }] },
  outputs: [{ file: 'golden.glb', targets: 'frames' }] });
const spatial = (shape, width = 0.2, more = {}) => of({ spatial: { ...shape, width, ...more } });
/** A recipe over the drum, which has texture coordinates, two materials and two primitives. */
const drum = (mask) => ({
  version: 1, name: 'golden', sources: { drum: 'drum.glb', bent: 'drum-bent.glb' },
  representation: 'laplacian', regions: { r: { mask: { on: 'drum', ...mask } } },
  timeline: { fps: 4, tracks: [{ region: 'r', to: 'bent', begin: 0, end: 1, ease: 'linear' }] },
  outputs: [{ file: 'golden.glb', targets: 'frames' }] });
/** A recipe that shows one shape of `states` and `derived` sources. */
const still = (states, derived = {}, regions = {}) => ({
  version: 1, name: 'golden', sources: { ...SOURCES, ...derived }, regions, states,
  timeline: { fps: 4, keys: [{ time: 0, state: 'orb' }, { time: 1, state: Object.keys(states)[0] }] },
  outputs: [{ file: 'golden.glb', targets: 'frames' }] });
const derived = (how, regions = {}) => still({ shown: { mix: 'made' } }, { made: how }, regions);
/** A recipe whose second shape is turned against the first. */
const represented = (representation) => ({ representation,
  ...derived({ transform: { of: 'nosed', rotate: { axis: [1, 2, 2], degrees: 120 }, scale: { factor: 0.6, along: [0, 0, 1] } } }) });
const keys = (pairs) => ({ keys: pairs.map(([time, value]) => ({ time, value })) });

export const RECIPES = {
  'ball': of(ball('nose', 0.2, 0.5)),
  'ball-edges': of({ ball: { on: 'orb', at: 'nose', inner: 0.2, outer: 0.5, distance: 'edges' }, falloff: 'smoothstep' }),
  'rings': of({ rings: { on: 'orb', inner: circle(0.7, 0.714), outer: circle(0.1, 0.995) }, falloff: 'cosine' }),
  'mask-attribute': drum({ attribute: 'TEXCOORD_0', channel: 1 }),
  'mask-material': drum({ material: 'paint-1' }),
  'mask-primitive': drum({ primitive: 0 }),
  'mask-image': drum({ image: 'mask.png' }),
  'scattered': of({ scattered: { on: 'orb', values: { nose: 1, tail: 0, side: 0.5 } } }),
  'half-space': spatial({ half_space: { normal: [0, 0, 1], offset: keys([[0, -1.2], [1, 1.2]]) } }),
  'slab': spatial({ slab: { normal: [1, 1, 0], offset: 0.1, thickness: 0.5 } }),
  'box': spatial({ box: { centre: [0.5, 0, 0], size: keys([[0, [0.5, 1, 1]], [1, [2, 2, 2]]]) } }),
  'sphere': spatial({ sphere: { centre: keys([[0, [-1, 0, 0]], [1, [1, 0, 0]]]), radius: 0.8 } }),
  'cylinder': spatial({ cylinder: { axis: [0, 1, 1], radius: 0.6, length: 1 } }),
  'ramp': of({ spatial: { ramp: { from: [0, -1, 0], to: [0, 1, 0] } } }),
  'expression': spatial({ expression: 'x + 0.2 * sin(8 * y) - t + 0.5' }, 0.1, { on: ['orb'] }),
  'flood-hops': of({ flood: { on: 'orb', from: ['nose', 'tail'], distance: 'hops', softness: 0 } }),
  'flood-geodesic': of({ flood: { on: 'orb', from: ['nose'], softness: 0.3 } }),
  'union': of({ union: ['a', 'b'] }, { regions: { a: ball('nose', 0.1, 0.4), b: ball('side', 0.1, 0.4) } }),
  'intersection': of({ intersection: ['a', 'b'] }, { regions: { a: ball('nose', 0.2, 0.6), b: ball('side', 0.2, 0.6) } }),
  'difference': of({ difference: ['a', 'b'] }, { regions: { a: ball('nose', 0.2, 0.6), b: ball('side', 0.2, 0.6) } }),
  'invert': of({ invert: 'a' }, { regions: { a: ball('nose', 0.1, 0.4) } }),
  'rest-of': of({ rest_of: ['a', 'b'] }, { regions: { a: ball('nose', 0.1, 0.4), b: ball('side', 0.1, 0.4) } }),
  'axes': still({ shown: { mix: ['long', { orb: 0.5, nosed: 0.5 }, 'orb'] } }),
  'caricature': still({ shown: { mix: { orb: -0.5, nosed: 1.5 }, extrapolate: true } }),
  'fit-rotate': still({ shown: { mix: 'orb', edits: [{ region: 'a', to: 'turned', fit: 'rotate' }] } },
    { turned: { transform: { of: 'nosed', rotate: { axis: [1, 0, 0], degrees: 20 } } } }, { a: ball('nose', 0.2, 0.5) }),
  'fit-similarity': still({ shown: { mix: 'orb', edits: [{ region: 'a', to: 'large', amount: 0.7, fit: 'similarity' }] } },
    { large: { transform: { of: 'nosed', scale: 1.5 } } }, { a: ball('nose', 0.2, 0.5) }),
  'band-low': derived({ band: { of: 'nosed', last: 24 } }),
  'band-pass': derived({ band: { of: 'nosed', first: 9, last: 100 } }),
  'band-filter': derived({ band: { of: 'nosed', last: 400 } }),
  'edit': derived({ edit: { of: 'orb', region: 'a', handles: [
    { region: 'b', translate: [0, 0.1, 0.4], rotate: { axis: [0, 0, 1], degrees: 30 }, scale: 0.8 },
    { at: 'side', to: [1.3, 0.1, 0.2] }] } }, { a: ball('nose', 0.6, 0.8), b: ball('nose', 0.1, 0.1) }),
  'edit-turned': derived({ edit: { of: 'orb', region: 'a', representation: 'rotation', handles: [
    { region: 'b', translate: [0, 0.1, 0.4], rotate: { axis: [0, 0, 1], degrees: 120 }, scale: 0.8 }] } },
  { a: ball('nose', 0.6, 0.8), b: ball('nose', 0.1, 0.1) }),
  'mirror': derived({ mirror: { of: 'long', symmetric: 'orb' } }),
  'transform': derived({ transform: { of: 'long', translate: [0, 1, 0], scale: { factor: 0.5, along: [0, 0, 1] } } }),
  'derived-of-derived': { representation: 'laplacian', ...still({ shown: { mix: 'twice' } }, {
    twice: { band: { of: 'once', last: 30 } }, once: { transform: { of: 'nosed', rotate: { degrees: 90 } } } }) },
  'rotation': represented('rotation'),
  'affine': represented('affine'),
  'rigid': represented('rigid'),
  'absolute': represented('absolute'),
  'bezier-and-after': { ...of(ball('nose', 0.2, 0.5)), timeline: { fps: 8, start: 'orb', tracks: [
    { region: 'r', to: 'long', begin: 0, duration: 0.5, ease: [0.4, 0, 0.2, 1] },
    { name: 'second', to: 'nosed', amount: 0.5, begin: { after: 'r', delay: -0.1 }, duration: 0.5, ease: 'cubic' }] } },
};

/** Files that recipes name besides their sources: 4 by 2 grey pixels. */
const MASK = deflateSync(Buffer.from([0, 0x00, 0x40, 0x80, 0xff, 0, 0xff, 0x80, 0x40, 0x00]));
export const FILES = { 'mask.png': png(4, 2, { kind: 0, pixels: MASK }) };
