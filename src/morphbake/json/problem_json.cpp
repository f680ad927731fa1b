#include "morphbake/json/problem_json.h"

namespace morphbake {

Json problem_to_json(const Problem& problem) {
  Json json = {{"severity", problem.severity == Severity::Error ? "error" : "warning"},
               {"code", problem.code},
               {"file", problem.location.file},
               {"pointer", problem.location.pointer}};
  if (problem.location.line > 0) json["line"] = problem.location.line;
  if (problem.location.column > 0) json["column"] = problem.location.column;
  json["message"] = problem.message;
  json["hint"] = problem.hint;
  return json;
}

Json problems_to_json(const std::vector<Problem>& problems) {
  Json list = Json::array();
  for (const Problem& problem : problems) list.push_back(problem_to_json(problem));
  return list;
}

}  // namespace morphbake
