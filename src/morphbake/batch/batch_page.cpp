#include "morphbake/batch/batch_page.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "morphbake/batch/batch_page_parts.h"
#include "morphbake/diagnostics/shown_text.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

/// As text of HTML, also in quotes; of control characters line breaks stay.
std::string escaped_lines(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += letter;
    }
  }
  return safe;
}

/// One line of it.
std::string escaped(const std::string& text) {
  return escaped_lines(without_control_characters(text));
}

/// Several lines, which control characters do not disturb.
std::string escaped_text(const std::string& text) {
  std::string safe;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    safe += (begin > 0 ? "\n" : "") + escaped(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return safe;
}

/// A file beside the page as a relative URL.
std::string url_of(const std::string& file) {
  constexpr std::string_view kPlain = "-._~/";
  std::string url = "./";
  for (const char letter : file) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool is_plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                          (byte >= 'a' && byte <= 'z') ||
                          kPlain.find(letter) != std::string_view::npos;
    url += is_plain ? std::string(1, letter) : fmt::format("%{:02X}", byte);
  }
  return url;
}

/// A cell that is sorted by a number and shows a text.
std::string number_cell(double number, const std::string& shown_number) {
  return fmt::format("<td class=n data-v={}>{}</td>", number, escaped(shown_number));
}

std::string picture_cell(const BatchRecord& record) {
  const auto picture = std::ranges::find_if(record.outputs, [](const FileState& output) {
    return output.file.ends_with(".sheet.png") || output.file.ends_with(".gif");
  });
  if (picture == record.outputs.end()) return "<td class=pic></td>";
  const std::string url = url_of(picture->file);
  return fmt::format(
      "<td class=pic><a href=\"{0}\"><img loading=lazy src=\"{0}\" alt=\"{1}\"></a></td>", url,
      escaped("pictures of " + record.name));
}

std::string problems_of(const BatchRecord& record, Severity severity, const char* style) {
  std::string text;
  for (const Problem& problem : record.problems) {
    if (problem.severity != severity) continue;
    text += fmt::format("<p class={}>{}</p>", style, escaped_text(format_problem(problem)));
  }
  return text;
}

/// The files that were written, and what was told of them.
std::string name_cell(const BatchRecord& record) {
  std::string cell = fmt::format("<td class=name data-v=\"{0}\"><b>{0}</b>", escaped(record.name));
  for (const FileState& output : record.outputs) {
    if (!output.file.ends_with(".glb")) continue;
    const std::string file = output.file.substr(output.file.rfind('/') + 1);
    cell += fmt::format(" <a href=\"{}\">{}</a>", url_of(output.file), escaped(file));
  }
  cell += problems_of(record, Severity::Error, "error");
  const std::string warnings = problems_of(record, Severity::Warning, "warning");
  if (!warnings.empty()) {
    cell += fmt::format("<details><summary>warnings</summary>{}</details>", warnings);
  }
  if (!record.log.empty()) {
    cell += fmt::format("<details><summary>printed at the end</summary><pre>{}</pre></details>",
                        escaped_text(record.log));
  }
  return cell + "</td>";
}

std::string stages_title(const BakeSummary& summary) {
  std::string title;
  for (const StageReport& stage : summary.stages) {
    title += fmt::format("{}{} {:.2f} s", title.empty() ? "" : ", ", stage.name, stage.seconds);
  }
  return title;
}

std::string summary_cells(const BakeSummary& summary) {
  return number_cell(summary.vertices, fmt::format("{}", summary.vertices)) +
         number_cell(summary.targets, fmt::format("{}", summary.targets)) +
         number_cell(static_cast<double>(summary.bytes),
                     shown_bytes(static_cast<double>(summary.bytes))) +
         number_cell(summary.max_error, fmt::format("{:.1e}", summary.max_error)) +
         number_cell(summary.normal_error, fmt::format("{:.2f}°", summary.normal_error));
}

}  // namespace

void write_page_start(std::ostream& page, const BatchProgress& progress) {
  page << kPageStart
       << fmt::format(
              "<p><span id=shown>{0}</span> of {0} recipes; {1} failed. morphbake {2}.</p>\n",
              progress.total, progress.failed, version())
       << kTableStart;
}

void write_page_row(std::ostream& page, const BatchRecord& record) {
  const char* state = record.is_done ? "done" : "failed";
  const BakeSummary* summary = record.summary ? &*record.summary : nullptr;
  page << fmt::format("<tr data-state={0}>{1}{2}<td><span class={0}>{0}</span></td>", state,
                      picture_cell(record), name_cell(record));
  page << (summary != nullptr ? summary_cells(*summary) : std::string(kNoSummary));
  page << fmt::format("<td class=n data-v={0} title=\"{1}\">{0:.2f}</td>", record.seconds,
                      summary != nullptr ? escaped(stages_title(*summary)) : "");
  const auto cached = summary != nullptr ? summary->cached : std::vector<std::string>();
  page << fmt::format("<td class=n data-v={0} title=\"{1}\">{0}</td></tr>\n", cached.size(),
                      escaped(fmt::format("{}", fmt::join(cached, ", "))));
}

void write_page_end(std::ostream& page) { page << kPageEnd; }

}  // namespace morphbake
