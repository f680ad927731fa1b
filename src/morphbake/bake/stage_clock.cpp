#include "morphbake/bake/stage_clock.h"

namespace morphbake {

void StageClock::end_running() {
  if (stages_.empty()) return;
  stages_.back().seconds = std::chrono::duration<double>(Clock::now() - began_).count();
}

void StageClock::start(const std::string& name) {
  end_running();
  stages_.push_back({name, 0});
  began_ = Clock::now();
  advance(observer_, {stages_.back().name, 0, 1});
}

std::vector<StageReport> StageClock::finish() {
  end_running();
  return std::move(stages_);
}

}  // namespace morphbake
