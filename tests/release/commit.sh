# The commit that a build tells: bash commit.sh ROOT SCRATCH
set -u
root=$1 scratch=$2 failures=0
rm -rf "$scratch"
mkdir -p "$scratch/clone/src" "$scratch/clone/docs" "$scratch/clone/cmake"
cd "$scratch/clone" || exit 1
echo '@PROJECT_VERSION@ (@MORPHBAKE_COMMIT@)' >../in
cp "$root/cmake/commit.txt" cmake
cp "$root/.gitattributes" .
touch src/a.cpp docs/a.md
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
git() { command git -c user.name=a -c user.email=a@b.example -c init.defaultBranch=main "$@"; }

commit_is() { # EXPECTED OF FOLDER
  rm -f "$scratch/out"
  cmake -DROOT="$2" -DVERSION=1.2.3 -DINPUT="$scratch/in" -DOUTPUT="$scratch/out" -P "$root/cmake/morphbake-commit.cmake"
  [ "$(cat "$scratch/out")" = "1.2.3 ($1)" ] || { echo "WRONG: $(cat "$scratch/out") instead of ($1) in $2"; failures=1; }
}

git -C .. init -q
commit_is "" "$PWD"  # it lies in the repository of somebody else, without a commit
git -C .. commit -q --allow-empty -m another
commit_is "" "$PWD"
git init -q
commit_is "" "$PWD"  # no commit
git add . && git commit -q -m first
hash=$(git rev-parse HEAD)
commit_is "${hash:0:9}" "$PWD"
before=$(stat -c %y "$scratch/out")
cmake -DROOT="$PWD" -DVERSION=1.2.3 -DINPUT="$scratch/in" -DOUTPUT="$scratch/out" -P "$root/cmake/morphbake-commit.cmake"
[ "$before" = "$(stat -c %y "$scratch/out")" ] || { echo "WRONG: written again without a change"; failures=1; }
echo text >docs/a.md
commit_is "${hash:0:9}" "$PWD"  # no file of the program
touch src/b.cpp
commit_is "${hash:0:9}-dirty" "$PWD"
rm src/b.cpp
echo "// text" >src/a.cpp
commit_is "${hash:0:9}-dirty" "$PWD"
git checkout -q src
mkdir "$scratch/tar ball" "$scratch/copy"
git archive HEAD | tar -x -C "$scratch/tar ball"
commit_is "${hash:0:9}" "$scratch/tar ball"
cp -r src cmake "$scratch/copy"
commit_is "" "$scratch/copy"
[ $failures = 0 ] && echo "all right"
exit $failures
