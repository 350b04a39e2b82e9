#pragma once

#include <memory>

#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::test {

/// A sampled study that is ready to run.
struct Prepared {
  explicit Prepared(const Study& of)
      : study(of), model(build_model(of.mechanism)), plan(of, select_poses(of.poses, *model).poses) {}
  Study study;
  std::unique_ptr<Model> model;
  Plan plan;
};

}  // namespace poesy::test
