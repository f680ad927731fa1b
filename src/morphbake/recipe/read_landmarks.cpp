#include "morphbake/recipe/read_landmarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/json/schema.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr double kSharesTolerance = 1e-6;
constexpr const char* kThreeWays =
    R"(a point is {"position": [x, y, z]}, {"vertex": n} or {"face": n, "barycentric": [a, b, c]})";

Eigen::Vector3d vector_of(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

/// An index; one that is out of range, which the schema has reported, must not overflow.
int index_from(const Json& json) {
  return static_cast<int>(std::clamp(json.get<double>(), 0.0, 2147483646.0));
}

/// A vector as JSON: nlohmann writes the shortest decimal that reads back as the same double.
Json json_of(const Eigen::Vector3d& vector) {
  return Json::array({vector.x(), vector.y(), vector.z()});
}

Json json_of(const Place& place) {
  if (const auto* position = std::get_if<Eigen::Vector3d>(&place)) {
    return {{"position", json_of(*position)}};
  }
  if (const auto* at = std::get_if<VertexPlace>(&place)) return {{"vertex", at->vertex}};
  const auto& at = std::get<TrianglePlace>(place);
  return {{"face", at.triangle}, {"barycentric", json_of(at.barycentric)}};
}

Place triangle_place(const Json& json, const Location& location, std::vector<Problem>& problems) {
  const TrianglePlace place{index_from(json["face"]), vector_of(json["barycentric"])};
  // What is out of range has been told already; its sum would only say so again.
  const bool in_range = place.barycentric.minCoeff() >= 0 && place.barycentric.maxCoeff() <= 1;
  if (in_range && std::abs(place.barycentric.sum() - 1) > kSharesTolerance) {
    problems.push_back({Severity::Error,
                        "landmarks.bad-shares",
                        {location.file, location.pointer + "/barycentric"},
                        fmt::format("the shares sum to {}, not 1", place.barycentric.sum()),
                        "the shares of a triangle's corners sum to 1"});
  }
  return place;
}

}  // namespace

Place place_of(const Json& json, const Location& location, std::vector<Problem>& problems) {
  const bool position = json.contains("position"), vertex = json.contains("vertex"),
             face = json.contains("face"), barycentric = json.contains("barycentric");
  const auto complain = [&](const char* code, std::string message) {
    problems.push_back({Severity::Error, code, location, std::move(message), kThreeWays});
  };
  if (position + vertex + (face || barycentric) > 1) {
    std::vector<std::string> fields;
    for (const auto& [field, value] : json.items()) fields.push_back('"' + field + '"');
    std::string list = fields.front();
    for (std::size_t i = 1; i < fields.size(); ++i) {
      list += (i + 1 == fields.size() ? " and " : ", ") + fields[i];
    }
    complain("landmarks.conflicting-fields", list + " exclude each other");
    return Eigen::Vector3d(0, 0, 0);
  }
  if (face != barycentric) {
    complain("landmarks.missing-field",
             face ? "\"face\" needs \"barycentric\" as well: where in the triangle"
                  : "\"barycentric\" needs \"face\" as well: in which triangle");
    return Eigen::Vector3d(0, 0, 0);
  }
  if (position) return vector_of(json["position"]);
  if (vertex) return VertexPlace{index_from(json["vertex"])};
  if (face) return triangle_place(json, location, problems);
  // Only fields that nobody knows, which the schema has told.
  return Eigen::Vector3d(0, 0, 0);
}

std::vector<Landmark> landmarks_of(const Json& object, const Location& location,
                                   std::vector<Problem>& problems) {
  std::vector<Landmark> landmarks;
  for (const auto& [name, json] : object.items()) {
    const Location at{location.file, child_pointer(location.pointer, name)};
    landmarks.push_back({name, place_of(json, at, problems)});
  }
  return landmarks;
}

fs::path landmarks_beside(const fs::path& source) {
  fs::path beside = source;
  return beside.replace_extension(".landmarks.json");
}

std::vector<Landmark> read_landmarks(const fs::path& file, const std::string& name) {
  const Json document = read_json(file, name);
  std::vector<Problem> problems =
      schema_problems(document, shipped_schema("landmarks.schema.json"), {name, ""});
  std::vector<Landmark> landmarks;
  const bool is_readable =
      std::all_of(problems.begin(), problems.end(),
                  [](const Problem& problem) { return problem.code == "landmarks.out-of-range"; });
  if (is_readable) landmarks = landmarks_of(document["landmarks"], {name, "/landmarks"}, problems);
  if (!problems.empty()) throw BakeError(std::move(problems));
  return landmarks;
}

std::string landmarks_to_json(const std::vector<Landmark>& landmarks, const fs::path& file,
                              const fs::path& schema) {
  Json json;
  if (!schema.empty()) json["$schema"] = relative_name(schema, file);
  json["version"] = 1;
  json["landmarks"] = Json::object();
  for (const Landmark& landmark : landmarks)
    json["landmarks"][landmark.name] = json_of(landmark.at);
  return json.dump(2) + "\n";
}

}  // namespace morphbake
