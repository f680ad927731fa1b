#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/json.h"
#include "morphbake/recipe/read_landmarks.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// What shares may name: a source, with a file or derived from another.
struct ShapeName {
  std::string name;
};

/// What the parts of read_recipe share while they read one document.
///
/// The document has the schema's types and required fields, so the parts only look at what a schema
/// cannot say: names, sums, order, files. Each goes on after a problem, to find the others as well.
struct Reading {
  const Json& document;
  std::filesystem::path folder;  ///< absolute: where relative names in the recipe start
  Recipe recipe;                 ///< filled in part by part
  std::vector<bool>
      landmarks_known;  ///< one a source: false when its landmark file could not be read
  std::vector<Problem> problems;
  std::vector<ShapeName> shapes = {};  ///< sources with a file, then derived ones
};

/// Adds an error at `pointer` of the recipe.
void complain(Reading& reading, std::string code, const std::string& pointer, std::string message,
              std::string hint);

/// Whether hints are still worth their time: comparing with all names is slow, and nobody reads
/// hundreds.
bool wants_hints(const Reading& reading);

/// Says that there is no `kind` called `name`, and which there are.
///
/// @param kind  in the singular: "region"
void complain_unknown(Reading& reading, const std::vector<std::string>& names,
                      std::string_view kind, const Json& name, const std::string& pointer);

/// The names of sources, regions, states, tracks or landmarks, in order.
template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& each : all) names.push_back(each.name);
  return names;
}

/// Index of what is called `name`, or -1 without a word.
template <typename Named>
int index_of(const std::vector<Named>& all, std::string_view name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& each) { return each.name == name; });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

/// Index of what is called `name`, or -1 after a complaint.
template <typename Named>
int look_up(Reading& reading, const std::vector<Named>& all, std::string_view kind,
            const Json& name, const std::string& pointer) {
  const int index = index_of(all, name.get<std::string>());
  if (index >= 0) return index;
  const bool hinted = wants_hints(reading);
  complain_unknown(reading, hinted ? names_of(all) : std::vector<std::string>(), kind, name,
                   pointer);
  return index;
}

/// Complains unless exactly one of `fields` is given.
///
/// @param what  the fields are, in the singular: "kind of region"
void check_one_of(Reading& reading, const Json& json, const std::vector<const char*>& fields,
                  const char* what, const std::string& pointer);

/// A name as the key of an object: complains when it is longer than importers take (63 bytes).
void check_name_length(Reading& reading, const std::string& name, const std::string& pointer);

/// One shape alone, or none for -1: #shapes.
Eigen::VectorXd pure_share(const Reading& reading, int shape);

/// A source's name, an object of shares, or three of these for x, y and z.
///
/// @param extrapolates  whether shares may lie beyond 0 and 1
Shares read_shares(Reading& reading, const Json& shares, bool extrapolates,
                   const std::string& pointer);

/// What a track or an edit changes.
Edit read_edit(Reading& reading, const Json& json, const std::string& pointer);

/// The region that `parent` names in its field "region", or -1 (the whole surface).
int read_region_field(Reading& reading, const Json& parent, const std::string& pointer);

/// A whole number; one that is out of range, which the schema has reported, must not overflow.
int whole_number(const Json& json);

/// The whole number in a field of `owner`; 0 where it is missing.
int whole_number(const Json& owner, const char* field);

/// The name or index in a field of `owner`, or no choice.
NameOrIndex name_or_index(const Json& owner, const char* field);

/// The absolute file that `as_written` names; complains when there is none.
std::filesystem::path existing_file(Reading& reading, const Json& as_written,
                                    const std::string& pointer);

/// A named curve, or the four numbers of a Bezier curve.
Easing ease_of(const Json& name);

/// Index of the state called `name`; a source of that name becomes a state of its own. -1 after a
/// complaint.
int state_index(Reading& reading, const Json& name, const std::string& pointer);

/// The cycles of a directed graph, one for each edge that closes one.
///
/// @param edges  targets of each node; those out of range are passed over
/// @return       lists of nodes, each with an edge to the next and the last to the first
std::vector<std::vector<int>> find_cycles(const std::vector<std::vector<int>>& edges);

/// A point of a source, by a landmark's name or itself; the origin after a complaint.
///
/// @param source  index, or -1 after a complaint about it
Place read_place(Reading& reading, const Json& at, int source, const std::string& pointer);

/// Whether a source of the recipe is made from another; complains unless it is given in one way.
bool is_derived(Reading& reading, const Json& source, const std::string& pointer);

/// Makes shapes of the derived sources called `names`, each after what it is made from.
void name_derived(Reading& reading, const std::vector<std::string>& names);

void read_sources(Reading& reading);
void read_connectivity(Reading& reading);
void read_regions(Reading& reading);
void read_derived(Reading& reading);
void read_states(Reading& reading);
void read_timeline(Reading& reading);
void read_constraints(Reading& reading);
void read_outputs(Reading& reading);
void read_preview(Reading& reading);

/// Complains about outputs with equal files, and about those that would overwrite a source.
void check_output_files(const Recipe& recipe, std::vector<Problem>& problems);

/// How a JSON file calls another: from its own folder on.
std::string relative_name(const std::filesystem::path& file, const std::filesystem::path& from);

/// The place that a landmark's fields give; the origin after a problem.
///
/// @param json  as the schema has it: a known field at least, all of the right type
Place place_of(const Json& json, const Location& location, std::vector<Problem>& problems);

/// The places that an object names.
std::vector<Landmark> landmarks_of(const Json& object, const Location& location,
                                   std::vector<Problem>& problems);

}  // namespace morphbake
