#include "morphbake/batch/batch_record.h"

#include <utility>

#include "morphbake/json/problem_json.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

constexpr JsonLimits kLimits = {std::size_t{1} << 16, std::size_t{1} << 20};
constexpr std::string_view kBegin = "{\"name\":";

/// A member that is a whole number of that type; the library converts any number, also one that is
/// too large.
template <class Number>
void read_whole(const Json& json, const char* member, Number& number) {
  const Json& value = json.at(member);
  const bool fits =
      value.is_number_unsigned()
          ? std::in_range<Number>(value.get<std::uint64_t>())
          : value.is_number_integer() && std::in_range<Number>(value.get<std::int64_t>());
  if (!fits) throw Json::type_error::create(302, "a whole number is too large, or is none", &value);
  value.get_to(number);
}

Json to_json(const FileState& state) {
  if (!state.is_there) return {{"file", state.file}, {"missing", true}};
  return {{"file", state.file},
          {"bytes", state.bytes},
          {"mtime_ns", state.mtime},
          {"hash", state.hash}};
}

FileState state_of(const Json& json) {
  FileState state;
  json.at("file").get_to(state.file);
  state.is_there = !json.contains("missing");
  if (!state.is_there) return state;
  read_whole(json, "bytes", state.bytes);
  read_whole(json, "mtime_ns", state.mtime);
  json.at("hash").get_to(state.hash);
  return state;
}

Json to_json(const BakeSummary& summary) {
  Json stages = Json::array();
  for (const StageReport& stage : summary.stages) {
    stages.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  return {{"vertices", summary.vertices},
          {"triangles", summary.triangles},
          {"frames", summary.frames},
          {"targets", summary.targets},
          {"bytes", summary.bytes},
          {"max_error", summary.max_error},
          {"normal_error", summary.normal_error},
          {"stages", std::move(stages)},
          {"cached", summary.cached}};
}

BakeSummary summary_of(const Json& json) {
  BakeSummary summary;
  read_whole(json, "vertices", summary.vertices);
  read_whole(json, "triangles", summary.triangles);
  read_whole(json, "frames", summary.frames);
  read_whole(json, "targets", summary.targets);
  read_whole(json, "bytes", summary.bytes);
  json.at("max_error").get_to(summary.max_error);
  json.at("normal_error").get_to(summary.normal_error);
  for (const Json& stage : json.at("stages")) {
    summary.stages.push_back(
        {stage.at("name").get<std::string>(), stage.at("seconds").get<double>()});
  }
  json.at("cached").get_to(summary.cached);
  return summary;
}

Problem problem_of(const Json& json) {
  Problem problem;
  problem.severity = json.at("severity") == "error" ? Severity::Error : Severity::Warning;
  json.at("code").get_to(problem.code);
  json.at("file").get_to(problem.location.file);
  json.at("pointer").get_to(problem.location.pointer);
  if (json.contains("line")) read_whole(json, "line", problem.location.line);
  if (json.contains("column")) read_whole(json, "column", problem.location.column);
  json.at("message").get_to(problem.message);
  json.at("hint").get_to(problem.hint);
  return problem;
}

Json list_of(const std::vector<FileState>& states) {
  Json list = Json::array();
  for (const FileState& state : states) list.push_back(to_json(state));
  return list;
}

BatchRecord record_of(const Json& json) {
  BatchRecord record;
  json.at("name").get_to(record.name);
  json.at("recipe").get_to(record.recipe);
  if (json.contains("set")) record.set = json["set"].dump();
  record.is_done = json.at("state") == "done";
  json.at("seconds").get_to(record.seconds);
  if (json.contains("bake")) record.summary = summary_of(json["bake"]);
  for (const Json& problem : json.at("problems")) record.problems.push_back(problem_of(problem));
  record.log = json.value("log", "");
  json.at("request").get_to(record.request);
  record.key = json.value("key", "");
  record.connectivity = json.value("connectivity", "");
  read_whole(json, "written_ns", record.written);
  for (const Json& state : json.at("inputs")) record.inputs.push_back(state_of(state));
  for (const Json& state : json.at("outputs")) record.outputs.push_back(state_of(state));
  return record;
}

}  // namespace

std::string record_to_line(const BatchRecord& record) {
  Json json = {{"name", record.name},
               {"state", record.is_done ? "done" : "failed"},
               {"recipe", record.recipe}};
  if (!record.set.empty()) json["set"] = parse_json(record.set, "set", kLimits);
  json["seconds"] = record.seconds;
  if (record.summary) json["bake"] = to_json(*record.summary);
  json["problems"] = problems_to_json(record.problems);
  if (!record.log.empty()) json["log"] = record.log;
  json["morphbake"] = version_with_commit();
  json["request"] = record.request;
  if (!record.key.empty()) json["key"] = record.key;
  if (!record.connectivity.empty()) json["connectivity"] = record.connectivity;
  json["written_ns"] = record.written;
  json["inputs"] = list_of(record.inputs);
  json["outputs"] = list_of(record.outputs);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<BatchRecord> record_from_line(const std::string& line) {
  try {
    return record_of(parse_json(line, "report", kLimits));
  } catch (const BakeError&) {
  } catch (const Json::exception&) {
  }
  return {};
}

LineStart start_of_line(const std::string& line) {
  if (!line.starts_with(kBegin) || !line.ends_with('}')) return {};
  const std::size_t first = kBegin.size();
  std::size_t last = first + 1;
  while (last < line.size() && line[last] != '"') last += line[last] == '\\' ? 2 : 1;
  if (last >= line.size()) return {};
  const std::string_view rest = std::string_view(line).substr(last + 1);
  const bool is_done = rest.starts_with(R"(,"state":"done",)");
  if (!is_done && !rest.starts_with(R"(,"state":"failed",)")) return {};
  try {
    const Json name = parse_json(std::string_view(line).substr(first, last + 1 - first), "report");
    if (name.is_string()) return {name.get<std::string>(), is_done};
  } catch (const BakeError&) {
  }
  return {};
}

}  // namespace morphbake
