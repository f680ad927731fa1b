#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/files/files.h"
#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr double preview_pixel_limit = 5e8;

Still read_still(Reading& reading, const Json& at, const std::string& pointer) {
  if (at.is_string()) return {state_index(reading, at, pointer)};
  const double time = at.get<double>();
  const double duration = reading.recipe.timeline.duration;
  if (time > duration && duration > 0) {
    complain(reading, "recipe.out-of-range", pointer,
             fmt::format("{} s is after the end of the timeline, at {} s", time, duration), "");
  }
  return {time};
}

/// All of the timeline by the recipe's name, or parts of it by names of their own.
std::vector<Clip> read_clips(Reading& reading, const Json& output, const std::string& pointer) {
  const double duration = reading.recipe.timeline.duration;
  if (!output.contains("clips")) return {{reading.recipe.name, 0, duration}};
  std::vector<Clip> clips;
  for (const auto& [name, json] : output["clips"].items()) {
    const std::string at = child_pointer(pointer + "/clips", name);
    const Clip clip{name, json["begin"].get<double>(), json["end"].get<double>()};
    if (clip.end <= clip.begin) {
      complain(
          reading, "recipe.out-of-range", at + "/end",
          fmt::format("this clip ends at {} s, before it has begun at {} s", clip.end, clip.begin),
          "a clip lasts a while");
    }
    if (clip.end > duration && duration > 0) {
      complain(reading, "recipe.out-of-range", at + "/end",
               fmt::format("{} s is after the end of the timeline, at {} s", clip.end, duration),
               "");
    }
    clips.push_back(clip);
  }
  return clips;
}

NormalBounds read_normal_bounds(const Json& output) {
  const Json json = output.value("max_normal_error", Json());
  NormalBounds bounds;
  if (json.is_number()) bounds.maximum = json.get<double>();
  if (!json.is_object()) return bounds;
  if (json.contains("maximum")) bounds.maximum = json["maximum"].get<double>();
  if (json.contains("percentile_99")) bounds.percentile_99 = json["percentile_99"].get<double>();
  return bounds;
}

/// The profile that an output names: a shipped one, or a file beside the recipe.
std::optional<Profile> read_output_profile(Reading& reading, const Json& output,
                                           const std::string& pointer) {
  if (!output.contains("profile")) return {};
  const std::string name = output["profile"].get<std::string>();
  const fs::path file = reading.folder / name;
  try {
    return read_profile(name.ends_with(".json") ? file.string() : name);
  } catch (const BakeError& error) {
    for (const Problem& problem : error.problems()) {
      if (problem.code == "profile.unknown-name") {
        complain(reading, problem.code, pointer + "/profile", problem.message, problem.hint);
      } else {  // in the profile's own file
        reading.problems.push_back(problem);
      }
    }
  }
  return {};
}

/// What is asked for, else what the profile's client reads best, else what loses nothing.
Encoding read_encoding(Reading& reading, const Json& output, const std::string& pointer,
                       const std::optional<Profile>& profile) {
  const std::string name = output.value("encoding", "auto");
  if (name == "auto") return profile ? profile->encoding : Encoding::Sparse;
  const Encoding encoding = encoding_named(name);
  if (!profile || allows(*profile, encoding)) return encoding;
  complain(reading, "recipe.breaks-profile", pointer + "/encoding",
           fmt::format("{} does not read \"{}\"", profile->title, name),
           fmt::format("\"{}\" is what it reads best", name_of(profile->encoding)));
  return encoding;
}

TargetKind read_targets(Reading& reading, const Json& output, const std::string& pointer) {
  const TargetKind kind = target_kind_named(output.value("targets", "auto"));
  const Timeline& timeline = reading.recipe.timeline;
  const double frames = 1 + timeline.duration * timeline.frames_per_second;
  if (kind == TargetKind::Basis && frames > kMostFramesOfBasis) {
    complain(reading, "recipe.out-of-range", pointer + "/targets",
             fmt::format("a basis is found among {} frames at most; the timeline has {:.0f}",
                         kMostFramesOfBasis, frames),
             "use \"keyframes\", a lower fps or a shorter timeline");
  }
  return kind;
}

Output read_output(Reading& reading, const Json& json, const std::string& pointer) {
  Output output;
  output.file = inside_folder(reading.folder, json["file"].get<std::string>());
  if (output.file.empty()) {
    complain(reading, "recipe.outside-folder", pointer + "/file",
             fmt::format("{} leaves the recipe's folder", shown(json["file"])),
             "outputs are written below the recipe's folder; --output-dir chooses another one");
  }
  output.targets = read_targets(reading, json, pointer);
  output.max_error = json.value("max_error", output.max_error);
  output.max_normal_error = read_normal_bounds(json);
  output.profile = read_output_profile(reading, json, pointer);
  output.encoding = read_encoding(reading, json, pointer, output.profile);
  output.unmet_is_error = json.value("unmet", "") != "warning";
  if (!json.contains("still")) {
    output.clips = read_clips(reading, json, pointer);
    return output;
  }
  output.still = read_still(reading, json["still"]["at"], pointer + "/still/at");
  for (const char* field : {"targets", "clips"}) {
    if (!json.contains(field)) continue;
    complain(reading, "recipe.conflicting-fields", child_pointer(pointer, field),
             fmt::format("\"still\" and \"{}\" exclude each other", field),
             "a still is a plain mesh without morph targets: keep one of them");
  }
  return output;
}

std::vector<PreviewFormat> read_formats(Reading& reading, const Json& json) {
  std::vector<PreviewFormat> formats;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto format = json[i] == "png"   ? PreviewFormat::Png
                        : json[i] == "gif" ? PreviewFormat::Gif
                                           : PreviewFormat::Sheet;
    if (std::find(formats.begin(), formats.end(), format) != formats.end()) {
      complain(reading, "recipe.bad-value", child_pointer("/preview/formats", i),
               fmt::format("formats lists {} twice", shown(json[i])), "remove one of them");
    }
    formats.push_back(format);
  }
  return formats;
}

std::vector<MapKind> read_maps(Reading& reading, const Json& preview) {
  std::vector<MapKind> maps;
  const Json json = preview.value("maps", Json::array());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto kind = json[i] == "regions" ? MapKind::Regions : MapKind::Mix;
    if (std::find(maps.begin(), maps.end(), kind) != maps.end()) {
      complain(reading, "recipe.bad-value", child_pointer("/preview/maps", i),
               fmt::format("maps lists {} twice", shown(json[i])), "remove one of them");
    }
    if (kind == MapKind::Regions && reading.recipe.regions.empty()) {
      complain(reading, "recipe.missing-field", child_pointer("/preview/maps", i),
               "there is no region to draw", "add \"regions\", or remove the map");
    }
    maps.push_back(kind);
  }
  return maps;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (a.lexically_normal() == b.lexically_normal()) return true;
  return fs::equivalent(a, b, error) && !error;
}

std::string output_pointer(std::size_t index) { return child_pointer("/outputs", index) + "/file"; }

}  // namespace

void check_output_files(const Recipe& recipe, std::vector<Problem>& problems) {
  const auto complain_at = [&](std::size_t i, const char* code, std::string message,
                               const char* hint) {
    problems.push_back(
        {Severity::Error, code, location_in(recipe, output_pointer(i)), std::move(message), hint});
  };
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const fs::path& file = recipe.outputs[i].file;
    if (file.empty()) continue;
    const std::string name = shown(Json(file.filename().string()));
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(file, recipe.outputs[j].file)) continue;
      complain_at(i, "recipe.duplicate-output",
                  fmt::format("{} is written by outputs[{}] as well", name, j),
                  "give each output a file of its own");
      break;
    }
    for (const SourceRef& source : recipe.sources) {
      if (!same_file(file, source.file)) continue;
      complain_at(i, "recipe.overwrites-source",
                  fmt::format("{} is the file of the source {}", name, shown(Json(source.name))),
                  "write to another file; sources are never changed");
    }
  }
}

void read_outputs(Reading& reading) {
  const Json by_default = Json::array({{{"file", reading.recipe.name + ".glb"}}});
  const Json outputs = reading.document.value("outputs", by_default);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    reading.recipe.outputs.push_back(
        read_output(reading, outputs[i], child_pointer("/outputs", i)));
  }
  check_output_files(reading.recipe, reading.problems);
}

void read_preview(Reading& reading) {
  const auto json = reading.document.find("preview");
  if (json == reading.document.end()) return;
  PreviewRequest preview;
  const Json turntable = json->value("turntable", Json::object());
  if (turntable.contains("size")) {
    preview.width = whole_number(turntable["size"][0]);
    preview.height = whole_number(turntable["size"][1]);
  }
  if (turntable.contains("frames")) preview.frames = whole_number(turntable["frames"]);
  preview.formats = read_formats(reading, json->value("formats", Json::array({"gif", "sheet"})));
  preview.maps = read_maps(reading, *json);
  const double pixels = 1.0 * preview.width * preview.height * preview.frames;
  if (pixels > preview_pixel_limit) {
    complain(reading, "recipe.out-of-range", "/preview/turntable",
             fmt::format("{} pictures of {} by {} pixels are more than {} million pixels",
                         preview.frames, preview.width, preview.height, preview_pixel_limit / 1e6),
             "choose a smaller size or fewer frames");
  }
  reading.recipe.preview = std::move(preview);
}

}  // namespace morphbake
