#include "morphbake/profile/profile.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <variant>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/embedded.h"
#include "morphbake/json/nearest.h"
#include "morphbake/json/schema.h"

namespace morphbake {

// How the choices are written in files; found by nlohmann's conversions through their names.
NLOHMANN_JSON_SERIALIZE_ENUM(Evidence, {{Evidence::Client, "client"},
                                        {Evidence::Documentation, "documentation"}})
NLOHMANN_JSON_SERIALIZE_ENUM(SparseSupport, {{SparseSupport::None, "none"},
                                             {SparseSupport::WithView, "with-view"},
                                             {SparseSupport::Any, "any"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Encoding, {{Encoding::Float, "float"},
                                        {Encoding::Sparse, "sparse"},
                                        {Encoding::Quantized, "quantized"},
                                        {Encoding::Meshopt, "meshopt"}})

namespace {

constexpr std::string_view kSuffix = ".json";

/// A field: its name in files, and where its value is kept.
struct Field {
  const char* name;
  std::variant<std::string Profile::*, bool Profile::*, std::optional<int> Profile::*,
               std::vector<std::string> Profile::*, Evidence Profile::*, SparseSupport Profile::*,
               Encoding Profile::*>
      member;
};

constexpr Field kFields[] = {
    {"title", &Profile::title},
    {"evidence", &Profile::evidence},
    {"client", &Profile::client},
    {"version", &Profile::version},
    {"sources", &Profile::sources},
    {"most_targets", &Profile::most_targets},
    {"most_targets_with_normals", &Profile::most_targets_with_normals},
    {"most_active", &Profile::most_active},
    {"sparse", &Profile::sparse},
    {"sparse_over_shared_view", &Profile::sparse_over_shared_view},
    {"accessors_of_zeros", &Profile::accessors_of_zeros},
    {"mesh_quantization", &Profile::mesh_quantization},
    {"meshopt_compression", &Profile::meshopt_compression},
    {"interpolations", &Profile::interpolations},
    {"clamps_weights", &Profile::clamps_weights},
    {"empty_names", &Profile::empty_names},
    {"name_bytes", &Profile::name_bytes},
    {"forbidden_in_names", &Profile::forbidden_in_names},
    {"gpu_bytes", &Profile::gpu_bytes},
    {"gpu_bytes_with_normals", &Profile::gpu_bytes_with_normals},
    {"encoding", &Profile::encoding},
};

template <typename Value>
void read_value(const Json& json, Value& value) {
  json.get_to(value);
}

void read_value(const Json& json, std::optional<int>& value) { value = json.get<int>(); }

template <typename Value>
void write_value(Json& json, const char* name, const Value& value) {
  json[name] = value;
}

void write_value(Json& json, const char* name, const std::optional<int>& value) {
  if (value) json[name] = *value;
}

/// @param file  for messages
Profile profile_of(const Json& json, const std::string& file, const std::string& name) {
  std::vector<Problem> problems =
      schema_problems(json, shipped_schema("profile.schema.json"), {file, ""});
  if (!problems.empty()) throw BakeError(std::move(problems));
  Profile profile;
  profile.name = name;
  for (const Field& field : kFields) {
    const auto found = json.find(field.name);
    if (found == json.end()) continue;
    std::visit([&](auto member) { read_value(*found, profile.*member); }, field.member);
  }
  return profile;
}

bool is_path(const std::string& text) {
  return text.find('/') != std::string::npos || text.ends_with(kSuffix);
}

[[noreturn]] void fail_at_name(const std::string& name) {
  const std::string hint = name_hint(name, profile_names(), "profiles");
  throw BakeError(Problem{Severity::Error,
                          "profile.unknown-name",
                          {},
                          fmt::format("there is no profile {}", shown(Json(name))),
                          hint + "; a profile of your own is the path of a .json file"});
}

}  // namespace

Profile read_profile(const std::string& name_or_file) {
  if (is_path(name_or_file)) {
    const std::filesystem::path file = name_or_file;
    return profile_of(read_json(file, name_or_file), name_or_file, file.stem().string());
  }
  for (const EmbeddedFile& file : embedded_profiles()) {
    if (file.name != name_or_file + std::string(kSuffix)) continue;
    const std::string name(file.name);
    return profile_of(parse_json(file.text, name), name, name_or_file);
  }
  fail_at_name(name_or_file);
}

std::string name_of(Encoding encoding) { return Json(encoding).get<std::string>(); }

Encoding encoding_named(const std::string& name) { return Json(name).get<Encoding>(); }

bool allows(const Profile& profile, Encoding encoding) {
  switch (encoding) {
    case Encoding::Float:
      break;
    case Encoding::Sparse:
      return profile.sparse == SparseSupport::Any;
    case Encoding::Quantized:
      return profile.mesh_quantization;
    case Encoding::Meshopt:
      return profile.mesh_quantization && profile.meshopt_compression;
  }
  return true;
}

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_profiles()) {
    names.emplace_back(file.name.substr(0, file.name.size() - kSuffix.size()));
  }
  std::ranges::sort(names);
  return names;
}

std::vector<Profile> shipped_profiles() {
  std::vector<Profile> profiles;
  for (const std::string& name : profile_names()) profiles.push_back(read_profile(name));
  return profiles;
}

std::string profile_to_json(const Profile& profile) {
  Json json;
  for (const Field& field : kFields) {
    std::visit([&](auto member) { write_value(json, field.name, profile.*member); }, field.member);
  }
  return json.dump(2) + "\n";
}

std::optional<int> most_targets(const Profile& profile, bool with_normals) {
  const bool is_own = with_normals && profile.most_targets_with_normals;
  return is_own ? profile.most_targets_with_normals : profile.most_targets;
}

std::optional<double> gpu_bytes(const Profile& profile, const TargetVertices& rows) {
  const bool is_known = (rows.plain == 0 || profile.gpu_bytes) &&
                        (rows.with_normals == 0 || profile.gpu_bytes_with_normals);
  if (!is_known || (!profile.gpu_bytes && !profile.gpu_bytes_with_normals)) return std::nullopt;
  return rows.plain * profile.gpu_bytes.value_or(0) +
         rows.with_normals * profile.gpu_bytes_with_normals.value_or(0);
}

}  // namespace morphbake
