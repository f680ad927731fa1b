#include "morphbake/batch/batch_page_parts.h"

namespace morphbake {

constexpr std::string_view kPageStart = R"(<!doctype html>
<html lang=en>
<meta charset=utf-8>
<meta name=viewport content="width=device-width, initial-scale=1">
<meta name=color-scheme content="light dark">
<title>Library of morphs</title>
<style>
:root { --page: #fff; --text: #1d1f23; --faint: #667; --line: #dde0e5; --head: #f3f4f7; --good: #11703a; --bad: #b3261e; --warn: #8a5a00; --link: #1f5fbf }
@media (prefers-color-scheme: dark) {
  :root { --page: #16181c; --text: #e6e7ea; --faint: #9aa0ab; --line: #2d3138; --head: #1f2228; --good: #62c98c; --bad: #ff8a80; --warn: #e0b050; --link: #8ab4f8 }
}
body { margin: 0 auto; max-width: 90rem; padding: 1rem 1.5rem; background: var(--page); color: var(--text); font: 15px/1.45 system-ui, sans-serif }
h1 { font-size: 1.3rem; margin: 0 }
p { margin: .2rem 0; color: var(--faint) }
form { display: flex; gap: .8rem; flex-wrap: wrap; margin: .8rem 0 }
input, select { font: inherit; color: inherit; background: var(--head); border: 1px solid var(--line); border-radius: 6px; padding: .25rem .5rem }
input { min-width: 16rem }
table { border-collapse: collapse; width: 100% }
th { position: sticky; top: 0; background: var(--head); text-align: left; font-weight: 600; white-space: nowrap }
th, td { padding: .4rem .6rem; border-bottom: 1px solid var(--line); vertical-align: top }
th button { all: unset; cursor: pointer }
th button:focus-visible { outline: 2px solid var(--link); outline-offset: 3px }
th[aria-sort=ascending] button::after { content: " \25B2"; font-size: .7em }
th[aria-sort=descending] button::after { content: " \25BC"; font-size: .7em }
.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums }
.name { overflow-wrap: anywhere; min-width: 14rem }
.name a { margin-left: .4rem }
.pic { width: 14rem; padding: .3rem }
img { display: block; width: 14rem; max-height: 12rem; object-fit: contain; border-radius: 4px }
a { color: var(--link) }
.done { color: var(--good) }
.failed { color: var(--bad); font-weight: 600 }
.error, .warning { font-size: .87em; white-space: pre-line; margin: .3rem 0 0 }
.error { color: var(--bad) }
.warning { color: var(--warn) }
pre { overflow: auto; font-size: .85em }
summary { color: var(--faint); font-size: .87em; cursor: pointer }
tr[hidden] { display: none }
</style>
<h1>Library of morphs</h1>
)";

constexpr std::string_view kTableStart = R"(<form onsubmit="return false">
<input id=words type=search placeholder="part of a name" aria-label="part of a name">
<select id=state aria-label="state"><option value="">done and failed</option><option>done</option><option>failed</option></select>
</form>
<p>Max error: of positions, a share of the diagonal. Normals: degrees off. Cached: stages taken from the cache; point at a number for names, at seconds for those of each stage.</p>
<table>
<thead><tr><th></th>
<th><button>name</button></th><th><button>state</button></th><th class=n><button>vertices</button></th>
<th class=n><button>targets</button></th><th class=n><button>bytes</button></th>
<th class=n title="of positions, share of the diagonal"><button>max error</button></th>
<th class=n title="of normals, degrees"><button>normals</button></th>
<th class=n><button>seconds</button></th><th class=n title="stages from the cache"><button>cached</button></th></tr></thead>
<tbody>
)";

constexpr std::string_view kNoSummary =
    "<td class=n></td><td class=n></td><td class=n></td><td class=n></td><td class=n></td>";

constexpr std::string_view kPageEnd = R"(</tbody>
</table>
<script>
const body = document.querySelector('tbody');
const words = document.getElementById('words');
const state = document.getElementById('state');
const key = (row, column) => row.cells[column].dataset.v ?? row.cells[column].textContent;
function order(head) {
  const column = head.cellIndex;
  const turn = head.ariaSort === 'ascending' ? -1 : 1;
  for (const other of head.parentNode.cells) other.removeAttribute('aria-sort');
  head.setAttribute('aria-sort', turn > 0 ? 'ascending' : 'descending');
  const isNumber = head.classList.contains('n');
  const keyed = Array.from(body.rows, (row) => [key(row, column), row]);
  keyed.sort(([a], [b]) => {
    if (!a || !b) return !a - !b;  // what has no value is last either way
    return turn * (isNumber ? a - b : a.localeCompare(b, undefined, { numeric: true }));
  });
  body.append(...keyed.map(([, row]) => row));
}
function choose() {
  const part = words.value.toLowerCase();
  let shown = 0;
  for (const row of body.rows) {
    row.hidden = (state.value && row.dataset.state !== state.value) ||
      !row.cells[1].dataset.v.toLowerCase().includes(part);
    shown += !row.hidden;
  }
  document.getElementById('shown').textContent = shown;
}
for (const button of document.querySelectorAll('th button')) {
  button.onclick = () => order(button.parentNode);
}
words.oninput = choose;
state.onchange = choose;
</script>
</html>
)";

}  // namespace morphbake
