#include <string_view>

#include "morphbake/bake/golden.h"

namespace morphbake {
namespace {

/// Length of the UTF-8 sequence at the begin of `text` when XML 1.0 may have its character, else 0.
std::size_t xml_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
  if (length == 0 || first > 0xF4 || text.size() < length) return 0;
  unsigned code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  const unsigned smallest = length == 4 ? 0x10000 : length == 3 ? 0x800 : 0x80;
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool is_character =
      code >= smallest && code <= 0x10FFFF && !is_surrogate && code != 0xFFFE && code != 0xFFFF;
  return is_character ? length : 0;
}

/// Text for XML's attributes and elements alike.
std::string escaped(std::string_view text) {
  std::string xml;
  while (!text.empty()) {
    const std::size_t length = xml_character(text);
    const char first = text.front();
    if (length == 0) {
      xml += "\xEF\xBF\xBD";
    } else if (first == '&') {
      xml += "&amp;";
    } else if (first == '<') {
      xml += "&lt;";
    } else if (first == '>') {
      xml += "&gt;";
    } else if (first == '"') {
      xml += "&quot;";
    } else if (first == '\n' || first == '\t' || first == '\r') {
      xml += first == '\n' ? "&#10;" : first == '\t' ? "&#9;" : "&#13;";
    } else {
      xml += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return xml;
}

std::string attribute(std::string_view name, std::string_view value) {
  return std::string(" ") + std::string(name) + "=\"" + escaped(value) + '"';
}

/// <failure> or <error>.
std::string outcome(std::string_view element, std::string_view type, std::string_view message,
                    std::string_view details) {
  const std::string name(element);
  return "      <" + name + attribute("type", type) + attribute("message", message) + ">" +
         escaped(details) + "</" + name + ">\n";
}

std::string as_text(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += format_problem(problem) + "\n";
  return text;
}

/// The differences and where the evidence lies, a line each.
std::string details_of(const GoldenOutput& output) {
  std::string text;
  const auto add = [&](const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
      if (finding.is_difference) text += finding.message + " [" + finding.kind + "]\n";
    }
  };
  if (output.difference) {
    add(output.difference->findings);
    for (const MeshDifference& mesh : output.difference->meshes) add(mesh.findings);
  }
  for (const std::filesystem::path& file : output.evidence) {
    text += "evidence: " + file.string() + "\n";
  }
  return text;
}

std::string outcome_of(const GoldenOutput& output) {
  switch (output.verdict) {
    case GoldenVerdict::Different:
      return outcome("failure", "different", "differs from " + output.golden.string(),
                     details_of(output));
    case GoldenVerdict::Missing:
      return outcome("failure", "missing",
                     "nothing is stored as " + output.golden.string() + "; --accept stores it",
                     details_of(output));
    case GoldenVerdict::Failed:
      return outcome("error", "unreadable", "cannot compare with " + output.golden.string(),
                     as_text(output.problems));
    case GoldenVerdict::Same:
    case GoldenVerdict::Accepted:
      break;
  }
  return "";
}

std::string junit_case(const std::string& recipe, const std::string& name,
                       const std::string& result) {
  const std::string open =
      "    <testcase" + attribute("classname", recipe) + attribute("name", name);
  return result.empty() ? open + "/>\n" : open + ">\n" + result + "    </testcase>\n";
}

/// Cases of a suite, and how many of them are not all right.
struct JunitCount {
  int tests = 0;
  int failures = 0;
  int errors = 0;

  std::string attributes() const {
    return attribute("tests", std::to_string(tests)) +
           attribute("failures", std::to_string(failures)) +
           attribute("errors", std::to_string(errors));
  }
};

JunitCount count_of(const GoldenRecipe& recipe) {
  if (!recipe.problems.empty()) return {1, 0, 1};
  JunitCount count;
  for (const GoldenOutput& output : recipe.outputs) {
    ++count.tests;
    count.errors += output.verdict == GoldenVerdict::Failed;
    count.failures +=
        output.verdict == GoldenVerdict::Different || output.verdict == GoldenVerdict::Missing;
  }
  return count;
}

}  // namespace

std::string golden_junit(const std::vector<GoldenRecipe>& recipes) {
  JunitCount all;
  std::string suites;
  for (const GoldenRecipe& recipe : recipes) {
    const JunitCount count = count_of(recipe);
    all = {all.tests + count.tests, all.failures + count.failures, all.errors + count.errors};
    suites += "  <testsuite" + attribute("name", recipe.recipe) + count.attributes() + ">\n";
    if (!recipe.problems.empty()) {
      suites += junit_case(recipe.recipe, "bake",
                           outcome("error", "bake", "cannot be baked", as_text(recipe.problems)));
    }
    for (const GoldenOutput& output : recipe.outputs) {
      suites += junit_case(recipe.recipe, output.name, outcome_of(output));
    }
    suites += "  </testsuite>\n";
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" +
         attribute("name", "morphbake golden") + all.attributes() + ">\n" + suites +
         "</testsuites>\n";
}

}  // namespace morphbake
