# A first recipe over shapes of different triangles bakes. bash init.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

# Landmarks say what corresponds; without them the command that makes some is told.
cp "$shapes/egg.glb" "$shapes/giraffe.glb" .
run 2 init egg.glb giraffe.glb -o first.json
stderr_has "[landmarks.too-few]"
stderr_has "\`morphbake landmarks suggest egg.glb giraffe.glb\`"
[ -e first.json ] && wrong "wrote a recipe that does not bake"
cp "$shapes/egg.landmarks.json" .
run 2 init egg.glb giraffe.glb -o first.json
stderr_has "they have 0 in common"
stderr_has "--force"

# With them the recipe bakes; names that only one has are left out, as a bake does.
jq 'del(.landmarks[(.landmarks | keys)[0]])' "$shapes/giraffe.landmarks.json" >giraffe.landmarks.json
run 0 init egg.glb giraffe.glb -o first.json
stderr_has "[landmarks.missing]"
jq -e '.connectivity == {"mode": "remesh"} and .sources == {"egg": "egg.glb", "giraffe": "giraffe.glb"}' \
  first.json >/dev/null || wrong "odd recipe: $(cat first.json)"

# Of several meshes one is chosen.
jq -n --arg data "$(printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0' | base64 -w0)" '{
  asset: {version: "2.0"}, scene: 0, scenes: [{nodes: [0, 1]}],
  nodes: [{name: "left", mesh: 0}, {name: "right", mesh: 0, translation: [2, 0, 0]}],
  meshes: [{primitives: [{attributes: {POSITION: 0}}]}],
  accessors: [{bufferView: 0, componentType: 5126, count: 3, type: "VEC3", min: [0, 0, 0], max: [1, 1, 0]}],
  bufferViews: [{buffer: 0, byteLength: 36}],
  buffers: [{byteLength: 36, uri: ("data:application/octet-stream;base64," + $data)}]}' >two.gltf
cp two.gltf three.gltf
run 4 init two.gltf three.gltf -o chosen.json
stderr_has "--node"
run 0 init two.gltf three.gltf --node left -o chosen.json
jq -e '[.sources[].node] == ["left", "left"]' chosen.json >/dev/null || wrong "no node: $(cat chosen.json)"
run 0 init two.gltf three.gltf --node left --node 1 --force -o chosen.json
jq -e '[.sources[].node] == ["left", 1]' chosen.json >/dev/null || wrong "other nodes: $(cat chosen.json)"
run 2 init two.gltf three.gltf three.gltf --node left --node 1 --force -o chosen.json
stderr_has "once for each"
finish
