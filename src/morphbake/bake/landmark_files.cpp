#include "morphbake/bake/landmark_files.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "morphbake/files/files.h"
#include "morphbake/landmarks/suggest.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/preview/landmark_sheet.h"
#include "morphbake/recipe/read_landmarks.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

/// Refuses to replace a file.
void check_new(const fs::path& file, std::vector<Problem>& problems) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  problems.push_back({Severity::Error,
                      "usage.would-overwrite",
                      {file.string(), ""},
                      "the file exists",
                      "overwrite it with --force, or write elsewhere with --output-dir"});
}

fs::path in_folder(const fs::path& file, const fs::path& folder) {
  return folder.empty() ? file : folder / file.filename();
}

/// The surface of a file without its landmarks; the problems of both files are told at once.
std::vector<SourceSurface> surfaces_of(const std::vector<fs::path>& files,
                                       const Observer& observer) {
  std::vector<SourceSurface> surfaces;
  std::vector<Problem> problems;
  for (const fs::path& file : files) {
    const SourceRef ref{file.stem().string(), file, {}, {}};
    try {
      surfaces.push_back(source_surface(load_source(ref), ref, observer));
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return surfaces;
}

std::vector<Landmark> landmarks_at(const std::vector<std::string>& names,
                                   const Positions& positions) {
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < names.size(); ++i) {
    landmarks.push_back(
        {names[i], Eigen::Vector3d(positions.row(static_cast<Eigen::Index>(i)).transpose())});
  }
  return landmarks;
}

/// Tells when there are fewer than were asked for.
void warn_of_fewer(const LandmarkRequest& request, const SuggestedLandmarks& suggested,
                   const Observer& observer) {
  const auto found = static_cast<int>(suggested.names.size());
  if (found >= request.count) return;
  report(observer,
         {Severity::Warning,
          "landmarks.fewer",
          {request.b.string(), ""},
          fmt::format("{} landmarks of the {} wanted were found: more would lie too close to "
                      "these",
                      found, request.count),
          ""});
}

}  // namespace

std::vector<fs::path> write_suggested_landmarks(const LandmarkRequest& request,
                                                const Observer& observer) {
  const fs::path file_a = in_folder(landmarks_beside(request.a), request.folder);
  const fs::path file_b = in_folder(landmarks_beside(request.b), request.folder);
  const fs::path sheet_file = in_folder(request.a, request.folder)
                                  .replace_filename(request.a.stem().string() + "-" +
                                                    request.b.stem().string() + ".landmarks.png");
  if (fs::absolute(file_a).lexically_normal() == fs::absolute(file_b).lexically_normal()) {
    throw BakeError(Problem{Severity::Error,
                            "usage.bad-argument",
                            {},
                            "both files' landmarks would be written to " + file_a.string(),
                            "name two files of different names"});
  }
  std::vector<Problem> problems;
  if (!request.replace) {
    for (const fs::path& file : {file_a, file_b, sheet_file}) check_new(file, problems);
  }
  if (!problems.empty()) throw BakeError(std::move(problems));

  const std::vector<SourceSurface> surfaces = surfaces_of({request.a, request.b}, observer);
  const SuggestedLandmarks suggested =
      suggest_landmarks(surfaces[0], surfaces[1], {request.count}, observer);
  warn_of_fewer(request, suggested, observer);
  const Image sheet = render_landmark_sheet(
      {{request.a.stem().string(), read_animated_mesh(request.a), suggested.a},
       {request.b.stem().string(), read_animated_mesh(request.b), suggested.b}},
      suggested.names, {.threads = request.threads}, observer);
  PendingOutputs outputs;
  outputs.stage(file_a, landmarks_to_json(landmarks_at(suggested.names, suggested.a), file_a,
                                          request.schema));
  outputs.stage(file_b, landmarks_to_json(landmarks_at(suggested.names, suggested.b), file_b,
                                          request.schema));
  outputs.stage(sheet_file, encode_png(sheet));
  outputs.commit();
  return {file_a, file_b, sheet_file};
}

void write_landmark_sheet(const fs::path& file, const fs::path& landmarks, const fs::path& picture,
                          int threads, const Observer& observer) {
  const fs::path named = landmarks.empty() ? landmarks_beside(file) : landmarks;
  const SourceRef ref{file.stem().string(),
                      file,
                      read_landmarks(named, named.string()),
                      {named.string(), "/landmarks"}};
  const SourceSurface surface = source_surface(load_source(ref), ref, observer);
  Positions marks(static_cast<Eigen::Index>(surface.landmarks.size()), 3);
  for (std::size_t i = 0; i < surface.landmarks.size(); ++i) {
    marks.row(static_cast<Eigen::Index>(i)) =
        position_of(surface.mesh, surface.landmarks[i]).transpose();
  }
  const Image sheet = render_landmark_sheet({{surface.name, read_animated_mesh(file), marks}},
                                            surface.landmark_names, {.threads = threads}, observer);
  PendingOutputs outputs;
  outputs.stage(picture, encode_png(sheet));
  outputs.commit();
}

}  // namespace morphbake
