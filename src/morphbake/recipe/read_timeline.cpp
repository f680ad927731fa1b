#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "morphbake/recipe/reading.h"

namespace morphbake {
namespace {

constexpr double frame_limit = 100000;
// Sums of times in seconds: 0.1 + 0.2 must not come after 0.3.
constexpr double time_tolerance = 1e-9;

const std::string tracks_pointer = "/timeline/tracks";

std::string track_name(Reading& reading, const Json& track, const std::string& pointer) {
  if (track.contains("name")) return track["name"].get<std::string>();
  if (track.contains("region")) return track["region"].get<std::string>();
  if (track["to"].is_string()) return track["to"].get<std::string>();
  complain(reading, "recipe.missing-field", pointer, "field \"name\" is missing",
           "a track without a region and with shares has no name of its own; "
           "add for example \"name\": \"blend\"");
  return "";
}

void check_track_name(Reading& reading, const std::string& name, const Json& track,
                      const std::string& pointer) {
  const std::string at = track.contains("name") ? pointer + "/name" : pointer;
  check_name_length(reading, name, at);
  if (name.empty() || index_of(reading.recipe.timeline.tracks, name) < 0) return;
  complain(reading, "recipe.duplicate-name", at,
           fmt::format("another track is called {} as well", shown(Json(name))),
           "each track becomes a morph target: give it a \"name\" of its own");
}

void check_end_or_duration(Reading& reading, const Json& track, const std::string& pointer) {
  if (track.contains("end") && track.contains("duration")) {
    complain(reading, "recipe.conflicting-fields", pointer,
             "\"end\" and \"duration\" exclude each other", "keep one of them");
  } else if (!track.contains("end") && !track.contains("duration")) {
    complain(reading, "recipe.missing-field", pointer, "when does this track end?",
             "add \"end\" or \"duration\", in seconds");
  }
}

Track read_track(Reading& reading, const Json& json, const std::string& pointer) {
  Track track;
  track.name = track_name(reading, json, pointer);
  check_track_name(reading, track.name, json, pointer);
  track.edit = read_edit(reading, json, pointer);
  if (json.contains("ease")) track.ease = ease_of(json["ease"]);
  check_end_or_duration(reading, json, pointer);
  return track;
}

/// The track that `begin` refers to, or -1.
int begin_reference(Reading& reading, const Json& begin, const std::string& pointer) {
  if (!begin.is_object()) return -1;
  const bool after = begin.contains("after");
  const bool with = begin.contains("with");
  if (after && with) {
    complain(reading, "recipe.conflicting-fields", pointer,
             "\"after\" and \"with\" exclude each other", "keep one of them");
  } else if (!after && !with) {
    complain(reading, "recipe.missing-field", pointer, "when does this track begin?",
             "add \"after\" or \"with\" and the name of a track");
  }
  if (after == with) return -1;
  const char* field = after ? "after" : "with";
  return look_up(reading, reading.recipe.timeline.tracks, "track", begin[field],
                 child_pointer(pointer, field));
}

/// Complains about tracks that wait for each other.
bool check_cycles(Reading& reading, const std::vector<std::vector<int>>& references) {
  const std::vector<Track>& tracks = reading.recipe.timeline.tracks;
  const std::vector<std::vector<int>> cycles = find_cycles(references);
  for (const std::vector<int>& cycle : cycles) {
    std::string chain;
    for (const int track : cycle) chain += tracks[track].name + " -> ";
    const int first = cycle.front();
    complain(reading, "recipe.cycle",
             child_pointer(tracks_pointer, static_cast<std::size_t>(first)) + "/begin",
             fmt::format("tracks wait for each other: {}{}", chain, tracks[first].name),
             "one of them must begin at a time in seconds");
  }
  return !cycles.empty();
}

/// Fills in begin and end; a track is timed after the one that it refers to.
class TrackTimes {
 public:
  TrackTimes(Reading& reading, const Json& tracks, std::vector<std::vector<int>> references)
      : reading_(reading),
        tracks_(tracks),
        references_(std::move(references)),
        done_(references_.size(), false) {}

  void resolve(int index) {
    if (done_[index]) return;
    done_[index] = true;
    if (!references_[index].empty()) resolve(references_[index].front());
    const Json& json = tracks_[index];
    Track& track = reading_.recipe.timeline.tracks[index];
    const std::string pointer = child_pointer(tracks_pointer, static_cast<std::size_t>(index));
    track.begin = begin_of(index);
    if (track.begin < 0) {
      complain(reading_, "recipe.out-of-range", pointer + "/begin",
               fmt::format("this track begins at {} s, before the timeline", track.begin),
               "the timeline begins at 0");
    }
    track.end = json.contains("end") ? json["end"].get<double>()
                                     : track.begin + json.value("duration", 0.0);
    if (track.end < track.begin) {
      complain(
          reading_, "recipe.out-of-range", pointer + "/end",
          fmt::format("this track ends at {} s, before it begins at {} s", track.end, track.begin),
          "write \"duration\" instead of \"end\" to give its length");
    }
  }

 private:
  double begin_of(int index) const {
    const Json& begin = tracks_[index]["begin"];
    if (!begin.is_object()) return begin.get<double>();
    if (references_[index].empty()) return 0;
    const Track& other = reading_.recipe.timeline.tracks[references_[index].front()];
    return (begin.contains("after") ? other.end : other.begin) + begin.value("delay", 0.0);
  }

  Reading& reading_;
  const Json& tracks_;
  std::vector<std::vector<int>> references_;  ///< one or none a track
  std::vector<bool> done_;
};

void read_tracks(Reading& reading, const Json& tracks) {
  Timeline& timeline = reading.recipe.timeline;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    timeline.tracks.push_back(read_track(reading, tracks[i], child_pointer(tracks_pointer, i)));
  }
  std::vector<std::vector<int>> references(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const int reference =
        begin_reference(reading, tracks[i]["begin"], child_pointer(tracks_pointer, i) + "/begin");
    if (reference >= 0) references[i].push_back(reference);
  }
  if (check_cycles(reading, references)) return;
  TrackTimes times(reading, tracks, std::move(references));
  for (std::size_t i = 0; i < tracks.size(); ++i) times.resolve(static_cast<int>(i));
  for (const Track& track : timeline.tracks) {
    timeline.duration = std::max(timeline.duration, track.end);
  }
}

void read_keys(Reading& reading, const Json& keys) {
  Timeline& timeline = reading.recipe.timeline;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string pointer = child_pointer("/timeline/keys", i);
    Key key;
    key.time = keys[i]["time"].get<double>();
    key.state = state_index(reading, keys[i]["state"], pointer + "/state");
    if (keys[i].contains("ease")) key.ease = ease_of(keys[i]["ease"]);
    if (i == 0 && key.time != 0) {
      complain(reading, "recipe.out-of-range", pointer + "/time",
               fmt::format("the first key is at {} s", key.time), "the timeline begins at 0");
    }
    if (i > 0 && key.time <= timeline.keys.back().time) {
      complain(reading, "recipe.out-of-range", pointer + "/time",
               fmt::format("this key at {} s does not come after the one before, at {} s", key.time,
                           timeline.keys.back().time),
               "list keys by rising time");
    }
    timeline.duration = std::max(timeline.duration, key.time);
    timeline.keys.push_back(key);
  }
}

/// The recipe's own duration; keys rest in the last pose until then.
void read_duration(Reading& reading, const Json& json) {
  Timeline& timeline = reading.recipe.timeline;
  if (!json.contains("duration")) return;
  const double duration = json["duration"].get<double>();
  if (duration < timeline.duration - time_tolerance) {
    complain(reading, "recipe.out-of-range", "/timeline/duration",
             fmt::format("the timeline lasts {} s, but its last {} is at {} s", duration,
                         timeline.keys.empty() ? "track's end" : "key", timeline.duration),
             "leave duration out to have it computed");
  }
  if (!timeline.keys.empty() && duration > timeline.duration) {
    timeline.keys.push_back({duration, timeline.keys.back().state, Ease::Linear});
  }
  timeline.duration = std::max(duration, timeline.duration);
}

void check_frames(Reading& reading) {
  const Timeline& timeline = reading.recipe.timeline;
  const double frames = timeline.frames_per_second * timeline.duration;
  if (frames > frame_limit) {
    complain(
        reading, "recipe.out-of-range", "/timeline",
        fmt::format("{} s at {} frames per second are {} frames; at most {} are allowed",
                    timeline.duration, timeline.frames_per_second, std::ceil(frames), frame_limit),
        "lower \"fps\" or shorten the timeline");
  }
  // Where nothing could be timed that was said already.
  if (timeline.duration <= 0 && reading.problems.empty()) {
    complain(reading, "recipe.out-of-range", "/timeline", "the timeline lasts 0 s",
             "give a track a duration, or the timeline one");
  }
}

}  // namespace

void read_timeline(Reading& reading) {
  const Json& json = reading.document["timeline"];
  Timeline& timeline = reading.recipe.timeline;
  timeline.frames_per_second = json.value("fps", timeline.frames_per_second);
  timeline.start = pure_share(reading, 0);
  if (json.contains("start")) {
    timeline.start = read_shares(reading, json["start"], false, "/timeline/start");
  }
  if (json.contains("tracks") == json.contains("keys")) {
    const bool both = json.contains("keys");
    complain(reading, both ? "recipe.conflicting-fields" : "recipe.missing-field", "/timeline",
             both ? "\"tracks\" and \"keys\" exclude each other" : "the timeline is empty",
             both ? "keep one of them"
                  : "add \"tracks\" (regions that move by themselves) or \"keys\" (whole poses)");
    return;
  }
  if (json.contains("start") && json.contains("keys")) {
    complain(reading, "recipe.conflicting-fields", "/timeline/start",
             "\"start\" and \"keys\" exclude each other", "the first key's state is the start");
  }
  if (json.contains("tracks")) read_tracks(reading, json["tracks"]);
  if (json.contains("keys")) read_keys(reading, json["keys"]);
  read_duration(reading, json);
  check_frames(reading);
}

}  // namespace morphbake
