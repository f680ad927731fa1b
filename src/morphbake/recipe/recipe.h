#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/mesh_choice.h"
#include "morphbake/profile/profile.h"
#include "morphbake/recipe/derived_source.h"
#include "morphbake/recipe/landmark.h"
#include "morphbake/recipe/region.h"

namespace morphbake {

/// Shares of the sources in a mix: #sources by 1, or by 3 (x, y, z) in a recipe that has shares an
/// axis. Columns sum to 1; each share is in [0, 1] unless the recipe extrapolates.
using Shares = Eigen::MatrixXd;

/// How a source is moved onto the first one before anything else.
enum class Align { None, Translation, Rigid, Similarity, Affine };

struct SourceRef {
  std::string name;
  std::filesystem::path file;  ///< absolute
  std::vector<Landmark> landmarks;
  Location landmarks_at;  ///< of the object whose fields the landmarks are, for messages
  Align align = Align::None;
  MeshChoice choice = {};  ///< of the file's meshes, and its shape
};

/// How the sources get one connectivity.
enum class ConnectivityMode {
  Shared,    ///< they have it already
  Remesh,    ///< new triangles for any surfaces of one topological type
  Resample,  ///< they have it already, and get a new one of another resolution
};

/// Where a new connectivity has its vertices: see Sizing of connectivity/remesh_options.h.
enum class VertexSizing { Curvature, Uniform };

/// A texture for new triangles, painted from a source's colours.
struct TextureRequest {
  int of = 0;       ///< source
  int size = 2048;  ///< as AtlasOptions
  int padding = 4;  ///< likewise
};

/// The fields are those of RemeshOptions.
struct ConnectivityRequest {
  ConnectivityMode mode = ConnectivityMode::Shared;
  double max_error = 0.002;
  int max_vertices = 30000;
  double target_edge_length = 0.03;
  VertexSizing sizing = VertexSizing::Curvature;
  std::optional<TextureRequest> texture;  ///< none: colours stand at vertices
};

/// What of the sources is blended, see docs/method.md.
enum class Representation {
  Auto,       ///< Rotation where the shapes are turned against one another, else Laplacian
  Laplacian,  ///< differences along edges (Alexa 2003, section 4.1)
  Rotation,   ///< differences that are turned along: for sources that are bent or twisted
  Affine,     ///< weights of neighbours (section 4.2)
  Absolute,   ///< positions
  Rigid,      ///< positions, once motions have brought the sources together
};

/// How lengths in a recipe are meant.
enum class Units { Diagonal, Scene };

enum class Ease { Linear, Step, Smoothstep, Cubic, Bezier };

/// How a change speeds up and slows down.
struct Easing {
  // NOLINTNEXTLINE(google-explicit-constructor): the named curves need no more than their name
  Easing(Ease named = Ease::Linear) : kind(named) {}

  Ease kind;
  std::array<double, 4> control = {0, 0, 1, 1};  ///< for Bezier: x1, y1, x2, y2 as in CSS
};

/// How the shape that an edit leads to is turned and scaled before.
enum class Fit {
  None,
  Rotate,      ///< so that its soft ring lies on that of the start
  Similarity,  ///< and is as large
};

/// T' = (1 - a (1 - d)) T + a (1 - d) T~ (Alexa 2003, eq. 7, with an amount a).
struct Edit {
  int region = -1;  ///< index; -1 is the whole surface
  Shares to;
  double amount = 1;  ///< in [0, 1] unless the recipe extrapolates
  Fit fit = Fit::None;
};

/// An edit whose amount is eased from 0 to `edit.amount` between `begin` and `end`.
struct Track {
  std::string name;
  Edit edit;
  double begin = 0;  ///< seconds
  double end = 0;    ///< seconds, >= begin
  Easing ease = Ease::Smoothstep;
};

/// A mix of all sources with ordered local edits.
struct State {
  std::string name;
  Shares mix;
  std::vector<Edit> edits;
};

struct Key {
  double time = 0;  ///< seconds
  int state = 0;    ///< index into Recipe::states
  Easing ease;      ///< of the segment that ends in this key
};

/// Either keys or tracks. Starts at 0; `duration` is the last key's time or at least the last
/// track's end.
struct Timeline {
  double frames_per_second = 30;
  double duration = 0;  ///< seconds, > 0
  Shares start;         ///< for tracks
  std::vector<Track> tracks;
  std::vector<Key> keys;  ///< times rise strictly, the first is 0
};

/// What may not move at all.
struct Hold {
  enum class Rule { Auto, None, Regions };

  Rule rule = Rule::Auto;
  std::vector<int> regions;  ///< for Rule::Regions: what lies inside of them (d = 0)
};

/// Where components stand that hold nothing.
struct Gauge {
  enum class Kind { Auto, Region, Landmark, Anchor };

  Kind kind = Kind::Auto;
  int region = -1;  ///< for Kind::Region
  int source = 0;   ///< for Landmark and Anchor
  Place at;         ///< for Landmark and Anchor: on that source's surface
};

enum class TargetKind {
  Auto,       ///< Tracks where fixed shapes make up the timeline, else the fewest targets
  Tracks,     ///< one a track or key
  Keyframes,  ///< as few frames as keep the bounds, each fading into the next
  Basis,      ///< as few combined shapes as keep the bounds
  Frames,     ///< one a frame
};

/// A basis is found among no more frames: its time grows with their third power.
constexpr std::size_t kMostFramesOfBasis = 2000;

/// One moment or state as a plain mesh without animation.
struct Still {
  std::variant<double, int> at;  ///< seconds, or an index into Recipe::states
};

/// Bounds on the angle between written and exact normals, in degrees.
struct NormalBounds {
  std::optional<double> percentile_99;
  std::optional<double> maximum;
};

/// A part of the timeline that is an animation of its own.
struct Clip {
  std::string name;
  double begin = 0;  ///< seconds
  double end = 0;    ///< seconds, > begin
};

struct Output {
  std::filesystem::path file;  ///< absolute, .glb
  std::vector<Clip> clips;     ///< one at least, but for stills
  TargetKind targets = TargetKind::Auto;
  std::optional<Still> still;
  double max_error = 0.001;  ///< of positions, as a fraction of the first frame's diagonal
  NormalBounds max_normal_error;
  std::optional<Profile> profile;  ///< what it must keep to
  Encoding encoding = Encoding::Sparse;
  bool unmet_is_error = true;  ///< whether a bound that is not kept stops the bake
};

enum class PreviewFormat { Png, Gif, Sheet };

/// Pictures that explain a recipe instead of showing its result.
enum class MapKind {
  Regions,  ///< where each region is
  Mix,      ///< which source dominates where, over the timeline
};

struct PreviewRequest {
  int width = 512;
  int height = 512;
  int frames = 72;
  std::vector<PreviewFormat> formats;
  std::vector<MapKind> maps = {};
};

/// What one of a recipe's files wrote.
struct RecipePart {
  std::string pointer;         ///< in the whole recipe; "" is all that no other part has
  std::filesystem::path file;  ///< as messages call it
  int line = 0;                ///< of a change: where it is written; 0 for a file of the recipe
  int column = 0;              ///< likewise: the cell of a table; 0 where there are none
};

/// A scene recipe, all names resolved to indices, all defaults filled in.
struct Recipe {
  std::filesystem::path file;
  std::vector<RecipePart> parts;  ///< where it is written in several files; the first is all of it
  std::string name;
  Units units = Units::Diagonal;
  std::vector<SourceRef> sources;
  std::vector<DerivedSource> derived;  ///< shapes after those of the sources, each after its own
  ConnectivityRequest connectivity;
  std::vector<RegionOfInterest> regions;
  std::vector<State> states;
  Timeline timeline;
  Representation representation = Representation::Auto;
  Hold hold;
  Gauge gauge;
  std::vector<Output> outputs;
  std::optional<PreviewRequest> preview;
  std::string options = "{}";  ///< JSON text of the recipe's "options", see bake/options.h
  std::string document;        ///< JSON text of all of it, with what it includes
};

/// Who wrote what stands at `pointer`: of the longest part there, the last.
const RecipePart& part_at(const std::vector<RecipePart>& parts, std::string_view pointer);

/// The file of that part.
const std::filesystem::path& written_in(const std::vector<RecipePart>& parts,
                                        std::string_view pointer);

/// As recipes write it: "auto", "laplacian", "rotation", "affine", "absolute", "rigid".
std::string name_of(Representation representation);

/// @param name  one of those
Representation representation_named(const std::string& name);

/// As recipes write it: "auto", "tracks", "keyframes", "basis", "frames".
std::string name_of(TargetKind kind);

/// @param name  one of those
TargetKind target_kind_named(const std::string& name);

/// Whether any shares mix each axis by itself.
bool has_shares_an_axis(const Recipe& recipe);

/// Where something stands, for messages.
Location location_in(const Recipe& recipe, std::string pointer);

}  // namespace morphbake
