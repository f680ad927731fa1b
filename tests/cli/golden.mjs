// Recipes against stored results: nothing is stored but by --accept, and then whole files or none.
//
//   node golden.mjs MORPHBAKE SCRATCH GOOD_RECIPE
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { floatsOf, readGlb, writeGlb } from './glb.mjs';
import { filesBelow, startTesting } from './testing.mjs';
import { parseXml } from './xml.mjs';

const [program, scratch, recipe] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);
mkdirSync('tmp');
const golden = (code, ...words) => run(code, ['golden', ...words], { TMPDIR: path.join(scratch, 'tmp') });
const nothingLeft = (what) => check(readdirSync('tmp').length === 0, `${what}: left ${readdirSync('tmp')} in the temporary folder`);
const fresh = (name) => cpSync(path.dirname(recipe), name, { recursive: true });
fresh('a');
const STORED = 'a/golden/tetrahedra.glb';

// Nothing is stored.
const missing = golden(1, 'a/recipe.json', '--junit', 'out/junit.xml');
check(missing.stdout.includes(`missing    ${STORED}: --accept stores it`), `missing: ${missing.stdout}`);
check(!existsSync('a/golden'), 'stores without being told to');
check(existsSync('golden-differences/recipe/tetrahedra.glb'), 'the new file is no evidence');
check(missing.stdout.includes('golden-differences/recipe'), 'the place of the evidence is not told');
const suite = parseXml(readFileSync('out/junit.xml', 'utf8'));
check(suite.name === 'testsuites' && suite.attributes.tests === '1' && suite.attributes.failures === '1', JSON.stringify(suite));
const testcase = suite.children[0].children[0];
check(testcase.attributes.name === 'tetrahedra.glb' && testcase.children[0].name === 'failure' &&
  testcase.children[0].attributes.type === 'missing', JSON.stringify(testcase));

// Accepted, and from then on the same.
rmSync('golden-differences', { recursive: true });
check(golden(0, 'a/recipe.json', '--accept').stdout.includes(`accepted   ${STORED}`), 'does not say what is accepted');
check(filesBelow('a/golden').join() === 'tetrahedra.glb', `stored ${filesBelow('a/golden')}`);
const stored = readFileSync(STORED);
run(0, ['bake', 'a/recipe.json', '-o', 'baked', '--preview', 'none']);
check(stored.equals(readFileSync('baked/tetrahedra.glb')), 'what is stored is not what a bake writes');
check(golden(0, 'a/recipe.json').stdout.includes(`same       ${STORED}`), 'is not the same');
check(golden(0, 'a/recipe.json', '--accept').stdout.includes('same'), 'accepts what is the same');
check(!existsSync('golden-differences'), 'leaves evidence of nothing');
const parsed = parseXml((golden(0, 'a/recipe.json', '--junit', 'out/junit.xml'), readFileSync('out/junit.xml', 'utf8')));
check(parsed.attributes.failures === '0' && parsed.children[0].children[0].children.length === 0, JSON.stringify(parsed));

// Different: told, with evidence; the stored file stays as it is.
const other = readGlb(STORED);
const base = floatsOf(other, other.json.meshes[0].primitives[0].attributes.POSITION);
base.set(4, base.get(4) + 0.01);
writeGlb(STORED, other);
const changed = readFileSync(STORED);
const different = golden(1, 'a/recipe.json', '--junit', 'out/junit.xml');
check(different.stdout.includes('different  ') && different.stdout.includes('vertex 1 of primitive 0'), `different: ${different.stdout}`);
check(filesBelow('golden-differences/recipe').join() === 'tetrahedra.diff.json,tetrahedra.glb,tetrahedra.heatmap.glb',
  `evidence: ${filesBelow('golden-differences/recipe')}`);
check(readFileSync('golden-differences/recipe/tetrahedra.glb').equals(stored), 'the evidence is not the new file');
check(JSON.parse(readFileSync('golden-differences/recipe/tetrahedra.diff.json')).same === false, 'the JSON of the evidence');
const colours = readGlb('golden-differences/recipe/tetrahedra.heatmap.glb');
check(floatsOf(colours, colours.json.meshes[0].primitives[0].attributes.COLOR_0).length === base.length, 'the heat-map');
check(readFileSync(STORED).equals(changed), 'a test has changed what is stored');
const failure = parseXml(readFileSync('out/junit.xml', 'utf8')).children[0].children[0].children[0];
check(failure.attributes.type === 'different' && failure.text.includes('[positions]') &&
  failure.text.includes('golden-differences/recipe/tetrahedra.heatmap.glb'), JSON.stringify(failure));
const report = JSON.parse(golden(1, 'a/recipe.json', '--json', '--evidence-dir', 'elsewhere').stdout);
check(report.same === false && report.recipes[0].outputs[0].verdict === 'different' &&
  report.recipes[0].outputs[0].difference.meshes[0].vertices_beyond >= 1, JSON.stringify(report));
check(existsSync('elsewhere/recipe/tetrahedra.glb'), '--evidence-dir');
golden(0, 'a/recipe.json', '--tolerance', '0.1', '--normals', '180');

// Stored results elsewhere; names that XML must escape.
fresh('b & "c"');
golden(1, 'a/recipe.json', '--golden-dir', 'accepted', '--evidence-dir', 'e');
golden(0, 'b & "c"/recipe.json', '--golden-dir', 'accepted', '--accept');
check(existsSync('accepted/tetrahedra.glb') && !existsSync('b & "c"/golden'), '--golden-dir');
golden(0, 'b & "c"/recipe.json', '--golden-dir', 'accepted', '--junit', 'out/odd.xml');
check(parseXml(readFileSync('out/odd.xml', 'utf8')).children[0].attributes.name === 'b & "c"/recipe.json', 'an odd name');

// Two recipes: folders of their own for evidence; one stored file for both is refused.
golden(1, 'a/recipe.json', 'b & "c"/recipe.json', '--evidence-dir', 'two');
check(existsSync('two/a/recipe/tetrahedra.glb') && existsSync('two/b & "c"/recipe/tetrahedra.glb'), `evidence of two: ${filesBelow('two')}`);
const clash = golden(2, 'a/recipe.json', 'b & "c"/recipe.json', '--golden-dir', 'clash', '--accept');
check(clash.stderr.includes('[recipe.duplicate-output]'), clash.stderr);
check(!existsSync('clash'), 'stores one of two');

// A recipe that cannot be baked: an error, but the others are judged; with --accept nothing is stored.
writeFileSync('a/bad.json', readFileSync('a/recipe.json', 'utf8').replace('flat.gltf', 'none.gltf'));
const failed = golden(2, 'a/bad.json', 'a/recipe.json', '--junit', 'out/failed.xml', '--evidence-dir', 'f');
check(failed.stderr.includes('[recipe.missing-file]') && failed.stdout.includes('different'), failed.stdout + failed.stderr);
const suites = parseXml(readFileSync('out/failed.xml', 'utf8'));
check(suites.attributes.errors === '1' && suites.attributes.failures === '1' && suites.children[0].children[0].children[0].name === 'error', JSON.stringify(suites));
golden(2, 'a/recipe.json', 'a/bad.json', '--accept');
check(readFileSync(STORED).equals(changed), 'stores something though a bake failed');

// What is stored is no glTF: an error, until another is accepted.
writeFileSync(STORED, 'no glTF');
check(golden(2, 'a/recipe.json', '--evidence-dir', 'g').stderr.includes(`${STORED}: error`), 'the bad file is not named');
golden(0, 'a/recipe.json', '--accept');
check(readFileSync(STORED).equals(stored), 'a bad stored file is not replaced');

// Wrong arguments.
check(golden(2, 'none.json').stderr.includes('[files.missing]'), 'no such recipe');
golden(2);
golden(2, 'a/recipe.json', '--junit', 'a');
rmSync('a/golden', { recursive: true });
writeFileSync('a/golden', 'a file where the folder would be');
golden(2, 'a/recipe.json', '--accept');
check(readFileSync('a/golden', 'utf8').startsWith('a file'), 'replaces a file by a folder');
nothingLeft('at the end');
finish();
