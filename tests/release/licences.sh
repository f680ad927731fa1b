# Every package that the program is linked with, or compiled from, has its row in docs/licences.md, with the version that is
# installed and the licence that Debian tells: bash licences.sh PROGRAM ROOT BUILD NINJA
set -uo pipefail
program=$1 root=$2 build=$3 ninja=$4
table="$root/docs/licences.md" failures=0
wrong() { echo "WRONG: $*"; failures=$((failures + 1)); }
command -v dpkg-query >/dev/null || { echo "SKIPPED: this is not Debian"; exit 77; }

# package TAB version TAB licence
rows=$(sed -n 's/^| `\([^`]*\)` | [^|]* | \([^|]*\) | \([^|;]*\);.*/\1\t\2\t\3/p' "$table")
source_of() { dpkg-query -W -f '${source:Package}\n' "$1" 2>/dev/null | head -n 1; }
listed_sources=$(cut -f 1 <<<"$rows" | while read -r package; do source_of "$package"; done)
has_row() { grep -qxF "$1" <<<"$(cut -f 1 <<<"$rows")"; }

# Debian's packages that hold files, as "/usr/lib/x" or, unmerged, "/lib/x".
packages_of() { { xargs dpkg -S; } 2>/dev/null | sed 's/: .*//; s/,.*//; s/:.*//' | sort -u; }

# What the program says that it needs: a row has a package of the same source.
needed=$(objdump -p "$program" | sed -n 's/^ *NEEDED *//p')
[ "$(wc -l <<<"$needed")" -ge 5 ] || wrong "$program needs few libraries: $needed"
for library in $needed; do
  case $library in ld-linux*) continue ;; esac # the loader, of the C library
  file=$(realpath "$(ldd "$program" | sed -n "s|^\s*$library => \([^ ]*\).*|\1|p" | head -n 1)")
  package=$(printf '%s\n' "$file" "${file#/usr}" | packages_of)
  [ -n "$package" ] || { wrong "$library ($file) is of no package"; continue; }
  grep -qxF "$(source_of "$package")" <<<"$listed_sources" || wrong "$library, of the package $package, has no row in $table"
done

# What its objects were compiled from, as the build noted.
headers=$("$ninja" -C "$build" -t deps | awk '/^[^ ].*: #deps/ { ours = ($1 ~ /^src\//) } /^    / && ours { print $1 }' |
  sort -u | grep '/include/' | grep -v '^src/\|^\.\.')
[ "$(wc -l <<<"$headers")" -ge 1000 ] || wrong "few headers were noted: is $build built with Ninja?"
for package in $(grep '^/usr/' <<<"$headers" | packages_of); do
  case $package in libgcc-*-dev | libstdc++-*-dev) package=libstdc++-12-dev ;; esac # one row for the compiler's
  has_row "$package" || wrong "a header of the package $package is compiled in, but $table has no row for it"
done

# Those that pipeline/setup unpacks, and all that are installed to build.
for package in $(awk '$1 == "build" && $2 ~ /-dev$/ { print $2 }' "$root/pipeline/packages") libvalijson-dev; do
  has_row "$package" || wrong "$package of pipeline/packages has no row in $table"
done

# The rows tell what is so.
while IFS=$'\t' read -r package version licences; do
  installed=$(dpkg-query -W -f '${Version}' "$package" 2>/dev/null) || continue
  upstream=$(sed 's/^[0-9]*://' <<<"$installed")
  [[ $upstream == "$version"[.+-]* ]] || wrong "$package: version $version in $table, but $upstream is installed"
  notice=/usr/share/doc/$package/copyright
  grep -q '^Format:.*copyright-format' "$notice" || continue # no machine reads the others
  while read -r licence; do
    grep -qE "^License: *(.* (and|or) )?${licence//+/\\+}( |$)" "$notice" || wrong "$package: $notice tells no licence $licence"
  done < <(sed 's/, \| or /\n/g; s/ with .*//' <<<"$licences")
done <<<"$rows"
[ $failures = 0 ] && echo "all right: $(wc -l <<<"$rows") packages"
exit $((failures > 0))
