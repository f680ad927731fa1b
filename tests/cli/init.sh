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
finish
