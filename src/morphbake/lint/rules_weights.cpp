#include <fmt/core.h>

#include <algorithm>

#include "morphbake/lint/rules.h"

namespace morphbake {
namespace {

/// The faults of all channels of which `fault(channel)` tells one.
template <typename Test>
std::vector<Fault> faulty_channels(const LintSubject& at, const Test& fault) {
  std::vector<Fault> faults;
  for (const WeightsChannel& channel : at.survey.channels) {
    if (std::optional<Fault> found = fault(channel)) faults.push_back(std::move(*found));
  }
  return first_of(std::move(faults));
}

const char* name_of(Interpolation interpolation) {
  if (interpolation == Interpolation::Step) return "STEP";
  return interpolation == Interpolation::Linear ? "LINEAR" : "CUBICSPLINE";
}

std::vector<Fault> check_interpolation(const LintSubject& at) {
  return faulty_channels(at, [&](const WeightsChannel& channel) -> std::optional<Fault> {
    const std::string name = name_of(channel.curve.interpolation);
    if (std::ranges::find(at.profile.interpolations, name) != at.profile.interpolations.end()) {
      return std::nullopt;
    }
    return Fault{channel.pointer,
                 "the weights are " + name + ", which " + at.profile.title + " shows wrong",
                 "write LINEAR keys, as many as the curve needs"};
  });
}

std::vector<Fault> check_sparse_weights(const LintSubject& at) {
  return faulty_channels(at, [](const WeightsChannel& channel) -> std::optional<Fault> {
    if (!channel.weights.is_sparse && !channel.times.is_sparse) return std::nullopt;
    return Fault{channel.pointer, "the weights or times of the animation are sparse accessors",
                 "write them dense: they are small, and clients forget that case"};
  });
}

std::vector<Fault> check_float_weights(const LintSubject& at) {
  constexpr int kFloat = 5126;
  return faulty_channels(at, [](const WeightsChannel& channel) -> std::optional<Fault> {
    if (channel.weights.component_type == kFloat) return std::nullopt;
    return Fault{channel.pointer, "the weights are integers, in steps of 1/255 or so",
                 "float32 weights take little room and have no steps"};
  });
}

std::vector<Fault> check_first_key(const LintSubject& at) {
  return faulty_channels(at, [](const WeightsChannel& channel) -> std::optional<Fault> {
    if (channel.curve.times.empty() || channel.curve.times.front() == 0) return std::nullopt;
    return Fault{channel.pointer,
                 fmt::format("the first key is at {:.4g} s", channel.curve.times.front()),
                 "start at 0: clients differ in what they show before the first key"};
  });
}

std::vector<Fault> check_range(const LintSubject& at) {
  if (!at.profile.clamps_weights) return {};
  return faulty_channels(at, [&](const WeightsChannel& channel) -> std::optional<Fault> {
    const float low = channel.curve.values.minCoeff(), high = channel.curve.values.maxCoeff();
    if (low >= 0 && high <= 1) return std::nullopt;
    return Fault{channel.pointer,
                 fmt::format("weights go from {:.4g} to {:.4g}; {} clamps them to 0 and 1", low,
                             high, at.profile.title),
                 "fold their range into the base shape and the targets"};
  });
}

bool is_open(const AnimationCurve& curve) {
  const Eigen::Index last = curve.values.rows() - 1;
  return last > 0 && curve.values.row(0) != curve.values.row(last);
}

std::vector<Fault> open_loops(const LintSubject& at) {
  return faulty_channels(at, [](const WeightsChannel& channel) -> std::optional<Fault> {
    if (!is_open(channel.curve)) return std::nullopt;
    return Fault{channel.pointer, "the weights of the last key are not those of the first",
                 "where the clip is to loop, end it with its first frame"};
  });
}

std::vector<Fault> check_loop(const LintSubject& at) {
  return at.options.must_loop ? open_loops(at) : std::vector<Fault>{};
}

std::vector<Fault> note_loop(const LintSubject& at) {
  return at.options.must_loop ? std::vector<Fault>{} : open_loops(at);
}

std::vector<Fault> check_weights_length(const LintSubject& at) {
  std::vector<Fault> faults;
  const auto add = [&](const std::vector<double>& weights, const std::string& owner) {
    if (weights.empty() || weights.size() == static_cast<std::size_t>(at.facts.targets)) return;
    faults.push_back({owner + "/weights",
                      fmt::format("{} weights for {} targets", weights.size(), at.facts.targets),
                      "glTF wants one weight a target"});
  };
  add(at.survey.mesh_weights, at.survey.mesh_pointer);
  add(at.survey.node_weights, at.survey.node_pointer);
  return first_of(std::move(faults));
}

std::vector<Fault> check_rest_weights(const LintSubject& at) {
  if (at.survey.channels.empty()) return {};
  const auto& own =
      at.survey.node_weights.empty() ? at.survey.mesh_weights : at.survey.node_weights;
  const Eigen::RowVectorXf first = at.survey.channels.front().curve.values.row(0);
  bool is_first = own.size() == static_cast<std::size_t>(first.size());
  for (std::size_t t = 0; is_first && t < own.size(); ++t) {
    is_first = static_cast<float>(own[t]) == first(static_cast<Eigen::Index>(t));
  }
  if (is_first || (own.empty() && first.isZero(0))) return {};
  return {{at.survey.mesh_pointer + "/weights",
           own.empty() ? "the mesh has no weights, and its first animation does not begin at rest"
                       : "the weights at rest are not those with which the first animation begins",
           "write the first frame's weights, which clients show that do not play"}};
}

constexpr CheckedRule kRules[] = {
    {{"interpolation", FindingSeverity::Error,
      "weights with an interpolation that the client shows wrong (CUBICSPLINE, mostly)"},
     check_interpolation},
    {{"weights-range", FindingSeverity::Error,
      "weights below 0 or above 1, where the client clamps them"},
     check_range},
    {{"weights-length", FindingSeverity::Error,
      "weights of mesh or node that are not one a target"},
     check_weights_length},
    {{"loop", FindingSeverity::Error, "with --loop: a clip whose last key is not its first"},
     check_loop},
    {{"sparse-weights", FindingSeverity::Warning, "sparse accessors in an animation of weights"},
     check_sparse_weights},
    {{"rest-weights", FindingSeverity::Note,
      "mesh.weights missing or not those of the animation's first frame"},
     check_rest_weights},
    {{"integer-weights", FindingSeverity::Note, "animated weights that are not float32"},
     check_float_weights},
    {{"first-key", FindingSeverity::Note, "an animation whose first key is not at 0 s"},
     check_first_key},
    {{"open-loop", FindingSeverity::Note, "without --loop: a clip whose last key is not its first"},
     note_loop},
};

}  // namespace

std::span<const CheckedRule> weights_rules() { return kRules; }

}  // namespace morphbake
