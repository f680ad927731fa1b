#include <fmt/core.h>

#include <utility>

#include "morphbake/json/nearest.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr int listed_files = 10000;

/// Names of the regular files in `folder`.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (int i = 0; !error && entry != fs::directory_iterator() && i < listed_files; ++i) {
    if (entry->is_regular_file(error)) names.push_back(entry->path().filename().string());
    entry.increment(error);
  }
  return names;
}

/// Complains unless `file` is a regular file.
bool check_exists(Reading& reading, const fs::path& file, const Json& as_written,
                  const std::string& pointer) {
  std::error_code error;
  if (fs::is_regular_file(file, error)) return true;
  if (fs::is_directory(file, error)) {
    complain(reading, "recipe.missing-file", pointer,
             fmt::format("{} is a folder, not a file", shown(as_written)), "");
    return false;
  }
  if (fs::exists(file, error)) {
    complain(reading, "recipe.missing-file", pointer,
             fmt::format("{} is no regular file", shown(as_written)),
             "pipes and devices cannot be read");
    return false;
  }
  const fs::path folder = file.parent_path();
  const std::string written_folder = fs::path(as_written.get<std::string>()).parent_path().string();
  std::string hint = fmt::format("the folder {} does not exist", shown(Json(written_folder)));
  if (fs::is_directory(folder, error)) {
    const std::string nearest = nearest_name(file.filename().string(), files_in(folder));
    hint = nearest.empty() ? "file names start at the recipe's folder"
                           : fmt::format("did you mean \"{}\"?", nearest);
  }
  complain(reading, "recipe.missing-file", pointer,
           fmt::format("there is no file {}", shown(as_written)), std::move(hint));
  return false;
}

/// The folder of the file that wrote what stands at `pointer`, as messages call it.
fs::path folder_at(const Reading& reading, const std::string& pointer) {
  return written_in(reading.recipe.parts, pointer).parent_path();
}

fs::path absolute_file(const Reading& reading, const Json& as_written, const std::string& pointer) {
  const fs::path name = as_written.get<std::string>();
  return fs::absolute(folder_at(reading, pointer) / name).lexically_normal();
}

/// The landmarks of a file, or none after its problems were noted.
std::vector<Landmark> try_landmarks(Reading& reading, const fs::path& file,
                                    const std::string& name) {
  try {
    return read_landmarks(file, name);
  } catch (const BakeError& error) {
    const auto& found = error.problems();
    reading.problems.insert(reading.problems.end(), found.begin(), found.end());
    reading.landmarks_known.back() = false;
    return {};
  }
}

/// What messages call a file that stands as `name` at `pointer`.
std::string beside_recipe(const Reading& reading, const fs::path& name,
                          const std::string& pointer) {
  return (folder_at(reading, pointer) / name).lexically_normal().string();
}

/// Fills in the landmarks of a source and where they stand.
void read_source_landmarks(Reading& reading, const Json& source, const std::string& pointer,
                           SourceRef& ref) {
  const Json& file = source.is_object() ? source["file"] : source;
  ref.landmarks_at = location_in(reading.recipe, pointer);  // where none are, some could be
  if (source.is_object() && source.contains("landmarks")) {
    const Json& landmarks = source["landmarks"];
    if (landmarks.is_object()) {
      ref.landmarks_at = location_in(reading.recipe, pointer + "/landmarks");
      ref.landmarks = landmarks_of(landmarks, ref.landmarks_at, reading.problems);
      return;
    }
    const fs::path named = absolute_file(reading, landmarks, pointer);
    if (!check_exists(reading, named, landmarks, pointer + "/landmarks")) {
      reading.landmarks_known.back() = false;
      return;
    }
    ref.landmarks_at = {beside_recipe(reading, landmarks.get<std::string>(), pointer),
                        "/landmarks"};
    ref.landmarks = try_landmarks(reading, named, ref.landmarks_at.file);
    return;
  }
  const fs::path beside = landmarks_beside(absolute_file(reading, file, pointer));
  std::error_code error;
  if (!fs::is_regular_file(beside, error)) return;
  ref.landmarks_at = {beside_recipe(reading, landmarks_beside(file.get<std::string>()), pointer),
                      "/landmarks"};
  ref.landmarks = try_landmarks(reading, beside, ref.landmarks_at.file);
}

Align align_of(const Json& name) {
  if (name == "translation") return Align::Translation;
  if (name == "rigid") return Align::Rigid;
  if (name == "similarity") return Align::Similarity;
  if (name == "affine") return Align::Affine;
  return Align::None;
}

/// The first source stays where it is: others are aligned to it.
void read_align(Reading& reading, const Json& source, const std::string& pointer, SourceRef& ref) {
  if (!source.is_object() || !source.contains("align")) return;
  ref.align = align_of(source["align"]);
  if (ref.align == Align::None || !reading.recipe.sources.empty()) return;
  complain(reading, "recipe.conflicting-fields", pointer + "/align",
           fmt::format("\"{}\" is the first source, onto which the others are moved", ref.name),
           "leave it out here, and write it at the sources that shall move");
}

/// Which mesh of the file, and in which shape.
void read_choice(Reading& reading, const Json& source, const std::string& pointer,
                 MeshChoice& choice) {
  choice.node = name_or_index(source, "node");
  choice.mesh = name_or_index(source, "mesh");
  choice.target = name_or_index(source, "target");
  if (!source.contains("animation")) return;
  const Json& moment = source["animation"];
  choice.moment = Moment{name_or_index(moment, "name"), moment["time"].get<double>()};
  if (!is_chosen(choice.target)) return;
  complain(reading, "recipe.conflicting-fields", pointer + "/target",
           "a source is the shape of a target or that of a moment, not both",
           "leave out \"target\" or \"animation\"");
}

}  // namespace

std::filesystem::path existing_file(Reading& reading, const Json& as_written,
                                    const std::string& pointer) {
  fs::path file = absolute_file(reading, as_written, pointer);
  check_exists(reading, file, as_written, pointer);
  return file;
}

namespace {

void read_file_source(Reading& reading, const std::string& name, const Json& source) {
  const std::string pointer = child_pointer("/sources", name);
  reading.landmarks_known.push_back(true);
  const bool is_object = source.is_object();
  const Json& file = is_object ? source["file"] : source;
  SourceRef ref;
  ref.name = name;
  ref.file = existing_file(reading, file, is_object ? pointer + "/file" : pointer);
  if (is_object) read_choice(reading, source, pointer, ref.choice);
  read_source_landmarks(reading, source, pointer, ref);
  read_align(reading, source, pointer, ref);
  reading.recipe.sources.push_back(std::move(ref));
  reading.shapes.push_back({name});
}

/// What only a file has.
void check_derived_fields(Reading& reading, const Json& source, const std::string& pointer) {
  for (const char* field : {"landmarks", "align", "node", "mesh", "target", "animation"}) {
    if (!source.contains(field)) continue;
    complain(reading, "recipe.conflicting-fields", child_pointer(pointer, field),
             fmt::format("a source that is made from another has no \"{}\" of its own", field),
             "write it at the source with the file");
  }
}

}  // namespace

void read_sources(Reading& reading) {
  std::vector<std::string> derived;
  for (const auto& [name, source] : reading.document["sources"].items()) {
    const std::string pointer = child_pointer("/sources", name);
    check_name_length(reading, name, pointer);
    if (is_derived(reading, source, pointer)) {
      check_derived_fields(reading, source, pointer);
      derived.push_back(name);
    } else if (source.is_string() || source.contains("file")) {
      read_file_source(reading, name, source);
    }
  }
  if (reading.recipe.sources.empty()) {
    complain(reading, "recipe.missing-field", "/sources", "no source has a file",
             "other sources are made from one that has");
    // What follows needs a first source.
    reading.landmarks_known.push_back(false);
    reading.recipe.sources.push_back({});
    reading.shapes.push_back({});
  }
  name_derived(reading, derived);
}

}  // namespace morphbake
