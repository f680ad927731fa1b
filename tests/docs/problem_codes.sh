# Every code in the source has a line in docs/problems.md, and the other way round.
cd "$(dirname "$0")/../.." || exit 1
modules='usage|files|json|profile|recipe|sources|landmarks|options|gltf|correspondence|connectivity|linear|solve|derive|transition|basis|export|output|image|preview|memory|cache|batch'
in_source=$(grep -rhoE "\"($modules)\.[a-z-]+\"" src --include=*.cpp | tr -d '"' | grep -vE '\.(json|md|[a-z-]*-)$' | sort -u)
# Codes that are put together from a prefix.
for prefix in recipe landmarks options profile; do
  in_source+=$(printf '\n%s' $prefix.{unknown-field,missing-field,wrong-type,out-of-range,bad-value})
done
in_source+=$(printf '\n%s' gltf.{missing-field,wrong-type,out-of-range,bad-value})
in_source+=$(printf '\n%s' gltf.json-{syntax,duplicate-key,too-deep,too-long,too-many-values} gltf.no-such-{node,target,animation})
in_docs=$(grep -oE "\`($modules)\.[a-z-]+\`" docs/problems.md | tr -d '`' | grep -vE '\.json$' | sort -u)
difference=$(diff <(sort -u <<<"$in_source") <(echo "$in_docs")) && { echo "$(wc -l <<<"$in_docs") codes"; exit 0; }
echo "only in the source (<) or only in docs/problems.md (>):"
echo "$difference"
exit 1
