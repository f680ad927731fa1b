#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/animation_curve.h"
#include "morphbake/gltf/animation_pointer.h"
#include "morphbake/gltf/morph_writing.h"
#include "morphbake/gltf/replace_accessor.h"

namespace morphbake {
namespace {

/// Weights that a file may have in its animations however few bytes it has.
constexpr std::size_t kFewestWeights = std::size_t{1} << 22;

/// A sampler that moves the weights of the mesh.
struct WeightSampler {
  std::size_t animation = 0;
  std::size_t sampler = 0;
  std::vector<std::size_t> channels;  ///< those that move the weights
  bool is_only_weights = false;       ///< and no other channel reads it
};

/// Samplers of one curve: what they read, and how.
using Curve = std::tuple<int, int, std::string>;  // input, output, interpolation
using Curves = std::map<Curve, std::vector<WeightSampler>>;

Curve curve_of(const Json& sampler) {
  return {sampler.at("input").get<int>(), sampler.at("output").get<int>(),
          sampler.value("interpolation", "LINEAR")};
}

/// The morph's mesh, and the nodes that show it. Lists of the root are looked up once, since it may
/// have many fields.
struct Subject {
  const MorphWriting& writing;
  std::set<std::size_t> nodes;
};

Subject subject_of(const MorphWriting& writing) {
  Subject subject{writing, {}};
  const Json& nodes = writing.draft.json.at("nodes");
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].value("mesh", -1) == writing.mesh) subject.nodes.insert(n);
  }
  return subject;
}

/// Whether a channel moves the weights of the morph's mesh.
bool moves_weights(const Subject& subject, const Json& channel) {
  const Json& target = channel.at("target");
  if (target.at("path") == "weights") {
    return target.contains("node") && subject.nodes.contains(target["node"].get<std::size_t>());
  }
  const std::optional<PointedProperty> pointed = pointed_property(target);
  if (!pointed || pointed->property != "weights") return false;
  if (pointed->list == "nodes") return subject.nodes.contains(pointed->index);
  return pointed->list == "meshes" &&
         pointed->index == static_cast<std::size_t>(subject.writing.mesh);
}

void check_channel(const MorphWriting& writing, std::size_t animation, std::size_t sampler,
                   std::size_t sampler_count) {
  if (writing.own_targets == 0) {
    fail_at(writing.document, fmt::format("/animations/{}", animation), "gltf.invalid",
            "the animation moves weights of a mesh that has no morph targets",
            "export the file again, or without that animation");
  }
  if (sampler >= sampler_count) {
    fail_at(writing.document, fmt::format("/animations/{}/samplers/{}", animation, sampler),
            "gltf.invalid", "the sampler does not exist");
  }
}

/// The samplers of an animation that move the mesh's weights.
std::vector<WeightSampler> weight_samplers(const Subject& subject, const Json& animation,
                                           std::size_t index) {
  const Json &channels = animation.at("channels"), &samplers = animation.at("samplers");
  std::map<std::size_t, std::size_t> readers;  // of a sampler: channels of any kind
  std::map<std::size_t, WeightSampler> found;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto sampler = channels[c].at("sampler").get<std::size_t>();
    ++readers[sampler];
    if (!moves_weights(subject, channels[c])) continue;
    check_channel(subject.writing, index, sampler, samplers.size());
    WeightSampler& at = found[sampler];
    at.animation = index;
    at.sampler = sampler;
    at.channels.push_back(c);
  }
  std::vector<WeightSampler> list;
  for (auto& [sampler, at] : found) {
    at.is_only_weights = at.channels.size() == readers[sampler];
    list.push_back(std::move(at));
  }
  return list;
}

Curves weight_curves(const MorphWriting& writing) {
  Curves curves;
  const auto animations = writing.draft.json.find("animations");
  if (animations == writing.draft.json.end()) return curves;
  const Subject subject = subject_of(writing);
  for (std::size_t a = 0; a < animations->size(); ++a) {
    const Json& animation = (*animations)[a];
    for (WeightSampler& sampler : weight_samplers(subject, animation, a)) {
      const Json& json = animation.at("samplers")[sampler.sampler];
      curves[curve_of(json)].push_back(std::move(sampler));
    }
  }
  return curves;
}

/// Curves that show the same bytes again and again would each become one of their own.
void check_size(const MorphWriting& writing, const Curves& curves) {
  const GltfDocument& document = writing.document;
  std::size_t bytes = 0, weights = 0;
  for (const std::string_view buffer : document.buffers) bytes += buffer.size();
  const std::size_t limit = std::max(bytes, kFewestWeights);
  for (const auto& [curve, samplers] : curves) {
    const WeightSampler& first = samplers.front();
    const std::string pointer =
        fmt::format("/animations/{}/samplers/{}", first.animation, first.sampler);
    weights += accessor_count(document, std::get<1>(curve), pointer + "/output");
    if (weights <= limit) continue;  // counts are below 2^32 each: the sum cannot overflow
    fail_at(document, pointer, "gltf.too-large",
            fmt::format("animations of the mesh's weights have more than {} numbers, out of {} "
                        "bytes",
                        limit, bytes),
            "animations that share one long accessor need to share their times as well");
  }
}

/// The numbers of a weights curve with the new targets' after those of each key.
std::vector<float> extended(const AnimationCurve& curve, const std::vector<float>& added) {
  std::vector<float> numbers;
  const auto append = [&](const Eigen::MatrixXf& rows, Eigen::Index key, bool is_value) {
    for (Eigen::Index t = 0; t < rows.cols(); ++t) numbers.push_back(rows(key, t));
    for (const float weight : added) numbers.push_back(is_value ? weight : 0.0F);
  };
  const bool is_cubic = curve.interpolation == Interpolation::CubicSpline;
  for (Eigen::Index key = 0; key < curve.values.rows(); ++key) {
    if (is_cubic) append(curve.in_tangents, key, false);
    append(curve.values, key, true);
    if (is_cubic) append(curve.out_tangents, key, false);
  }
  return numbers;
}

/// Lets the channels of weights read another output, and all others what they read before.
void set_output(Json& animations, const WeightSampler& at, int output) {
  Json& animation = animations[at.animation];
  Json& samplers = animation["samplers"];
  if (at.is_only_weights) {
    samplers[at.sampler]["output"] = output;
    return;
  }
  Json copy = samplers[at.sampler];
  copy["output"] = output;
  for (const std::size_t c : at.channels) animation["channels"][c]["sampler"] = samplers.size();
  samplers.push_back(std::move(copy));
}

}  // namespace

void extend_animations(MorphWriting& writing) {
  const Curves curves = weight_curves(writing);
  if (curves.empty()) return;
  check_size(writing, curves);
  Json& animations = writing.draft.json.at("animations");  // looked up once: the root may be long
  for (const auto& [curve, samplers] : curves) {
    const WeightSampler& first = samplers.front();
    const std::vector<float> numbers =
        extended(read_curve(writing.document, static_cast<int>(first.animation),
                            static_cast<int>(first.sampler), static_cast<int>(writing.own_targets)),
                 first_weights(writing.morph));
    const auto replaced = std::ranges::count_if(samplers, &WeightSampler::is_only_weights);
    const int output = replace_accessor(writing.draft, writing.references,
                                        {std::get<1>(curve), static_cast<int>(replaced)},
                                        {numbers.data(), numbers.size(), 1, BufferUse::Other});
    for (const WeightSampler& sampler : samplers) set_output(animations, sampler, output);
  }
}

}  // namespace morphbake
