# The Debian package on a Debian 12 that has nothing else: bash bare_debian.sh PROGRAM ROOT BUILD SCRATCH
#
# Packs what was built, unpacks a root made by debootstrap, installs the package there with apt, and bakes: the same bytes as
# the build's own program. Everything is mounted in a name space of its own, so that nothing stays mounted, whatever happens.
# BUILD/debian keeps the root and packages that were downloaded. MORPHBAKE_DEBIAN_MIRROR is asked, or deb.debian.org.
set -euo pipefail
program=$1 root=$2 build=$3 scratch=$4
mirror=${MORPHBAKE_DEBIAN_MIRROR-http://deb.debian.org/debian}
kept=$build/debian bare=$scratch/bare
say() { echo "== $*"; }
skip() { echo "SKIPPED: $*"; exit 77; }

[ "$(id -u)" = 0 ] || skip "only root makes a root"
for needed in debootstrap dpkg-shlibdeps file unshare; do
  command -v $needed >/dev/null || skip "$needed is not installed"
done
if [ "${MORPHBAKE_OWN_MOUNTS-}" != yes ]; then
  unshare --mount --propagation private true 2>/dev/null || skip "mounts cannot be kept apart here"
  MORPHBAKE_OWN_MOUNTS=yes exec unshare --mount --propagation private bash "$0" "$@"
fi
rm -rf "$scratch"
mkdir -p "$scratch" "$kept/archives"
trap 'umount -l "$bare/proc" 2>/dev/null || true; rm -rf "$bare"' EXIT
trap 'exit 1' INT TERM

say "packing"
(cd "$build" && cpack -G DEB -B "$scratch/packed" >"$scratch/cpack.log" 2>&1) || { cat "$scratch/cpack.log"; exit 1; }
package=$(ls "$scratch"/packed/morphbake_*.deb)
dpkg-deb -f "$package"
if command -v lintian >/dev/null; then
  say "lintian"
  lintian --fail-on error --allow-root "$package"
fi

if [ ! -e "$kept/bookworm.tar" ]; then
  say "debootstrap"
  if ! debootstrap --variant=minbase bookworm "$bare" "$mirror" >"$scratch/debootstrap.log" 2>&1; then
    tail -n 5 "$scratch/debootstrap.log"
    grep -q '^I: Extracting' "$scratch/debootstrap.log" && exit 1
    skip "debootstrap cannot reach $mirror"
  fi
  umount -l "$bare/proc" 2>/dev/null || true
  rm -f "$bare"/var/cache/apt/archives/*.deb
  tar -C "$bare" --one-file-system -cf "$kept/bookworm.tar.part" .
  mv "$kept/bookworm.tar.part" "$kept/bookworm.tar"
  rm -rf "$bare"
fi
mkdir -p "$bare"
tar -C "$bare" -xf "$kept/bookworm.tar"
cp /etc/resolv.conf /etc/hosts "$bare/etc/"
mount -t proc proc "$bare/proc"
in_bare() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C DEBIAN_FRONTEND=noninteractive \
  ${http_proxy:+http_proxy="$http_proxy"} chroot "$bare" "$@"; }

say "installing"
cp "$package" "$bare/root/"
cp -l "$kept"/archives/*.deb "$bare/var/cache/apt/archives/" 2>/dev/null || true
rm -f "$bare"/etc/apt/apt.conf.d/docker-clean
echo 'APT::Keep-Downloaded-Packages "true"; Binary::apt-get::APT::Keep-Downloaded-Packages "true";' >"$bare/etc/apt/apt.conf.d/90keep"
in_bare apt-get -q update >"$scratch/apt.log" 2>&1 || { cat "$scratch/apt.log"; skip "apt cannot reach $mirror"; }
in_bare apt-get -q -y --no-install-recommends install "/root/$(basename "$package")" >>"$scratch/apt.log" 2>&1 ||
  { tail -n 30 "$scratch/apt.log"; exit 1; }
cp -lf "$bare"/var/cache/apt/archives/*.deb "$kept/archives/"

say "running"
failures=0
wrong() { echo "WRONG: $*"; failures=$((failures + 1)); }
[ "$(in_bare morphbake --version)" = "$("$program" --version)" ] || wrong "version: $(in_bare morphbake --version)"
in_bare morphbake --version
in_bare morphbake bake /usr/share/doc/morphbake/examples/01_nose/recipe.json -o /root/out
"$program" bake "$root/examples/01_nose/recipe.json" -o "$scratch/out" >/dev/null
for file in long-nose.glb long-nose-still.glb; do
  cmp "$bare/root/out/$file" "$scratch/out/$file" || wrong "$file is not what the build bakes"
done
[ "$(head -c 6 "$bare/root/out/long-nose.gif")" = GIF89a ] || wrong "there is no moving preview"
in_bare morphbake init /usr/share/doc/morphbake/examples/shapes/cow.glb /usr/share/doc/morphbake/examples/shapes/pig.glb \
  -o /root/recipe.json
grep -q '"$schema": ".*share/morphbake/schemas/recipe.schema.json"' "$bare/root/recipe.json" || wrong "init finds no schema"
in_bare bash -c '. /usr/share/bash-completion/completions/morphbake
  COMP_WORDS=(morphbake insp) COMP_CWORD=1; _morphbake; [ "${COMPREPLY[*]}" = inspect ]' || wrong "nothing is completed"
for file in copyright changelog.Debian.gz README.md docs/licences.md licences/libcgal-dev licences/libvalijson-dev \
  schemas/recipe.schema.json; do
  [ -s "$bare/usr/share/doc/morphbake/$file" ] || wrong "there is no $file"
done
for file in share/morphbake/config/bake.json share/man/man1/morphbake.1.gz share/fish/vendor_completions.d/morphbake.fish; do
  [ -s "$bare/usr/$file" ] || wrong "there is no $file"
done

say "removing"
in_bare apt-get -q -y purge morphbake >>"$scratch/apt.log" 2>&1 || wrong "it cannot be removed"
left=$(find "$bare/usr" "$bare/etc" "$bare/var/lib" -name '*morphbake*' | sed "s|^$bare||")
[ -z "$left" ] || wrong "left behind: $left"
[ $failures = 0 ] && say "all right: $(du -h "$package" | cut -f 1) package, $(du -sh "$kept/archives" | cut -f 1) of dependencies"
exit $((failures > 0))
