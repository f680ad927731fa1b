# bash diff_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/diff.md, on two bases of one motion; every kind of
# finding stands in the table, and no other.
. "$(dirname "$0")/commands.sh"
cat >"$scratch/morph.json" <<RECIPE
{ "version": 1, "name": "nose",
  "sources": { "face": "$root/examples/shapes/face.glb", "other": "$root/examples/shapes/face_long_nose.glb" },
  "timeline": { "tracks": [{ "name": "nose", "to": "other", "begin": 0, "end": 1 }] },
  "outputs": [{ "file": "tracks.glb", "targets": "tracks" }, { "file": "frames.glb", "targets": "frames" }] }
RECIPE
morphbake bake morph.json
run_commands_of docs/diff.md
for file in where.glb where.sheet.png golden/tracks.glb golden/frames.glb accepted/frames.glb golden.xml; do
  [ -s "$file" ] || { echo "no $file"; exit 1; }
done
in_source=$(grep -hoE '(differ|mention|note_or_differ)\(\s*"[a-z-]+"|(true|is_judged|is_difference|options.strict), "[a-z-]+"' -z "$root"/src/morphbake/diff/*.cpp |
  tr '\0' '\n' | grep -oE '"[a-z-]+"' | tr -d '"' | sort -u)
in_docs=$(sed -n '/^| kind | meaning/,/^$/p' "$root/docs/diff.md" | sed -n 's/^| \(`[^|]*\) |.*/\1/p' | grep -oE '[a-z-]+' | sort -u)
diff <(echo "$in_source") <(echo "$in_docs") || { echo "kinds only in the source (<) or only in docs/diff.md (>)"; exit 1; }
