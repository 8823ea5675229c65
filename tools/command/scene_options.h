/* scene_options.h - the options that say what is simulated and how; run, diff and plan share them. */
#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include <tandem/backend.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

#include "tools/command/distinct_files.h"

namespace tandem {

/* Whole number in [lowest, highest]; InputError names the option. */
uint64_t whole_number(const std::string &option, const std::string &text, uint64_t lowest, uint64_t highest);
/* Any finite number, as strtod reads it. */
double real_number(const std::string &option, const std::string &text);

class SceneOptions {
public:
  /* `one_backend`: adds --on; diff names its backends otherwise. */
  SceneOptions(CLI::App &parser, bool one_backend);

  /* For commands that list events without writing them: a flag --events. */
  void add_events_flag(CLI::App &parser);

  /* After parsing. InputError on the first option that makes no sense. */
  Settings settings() const;
  Placement placement() const;
  uint64_t steps() const;
  /* InputError also where one of `files` is written and the scene is read from it. */
  Scene scene(DistinctFiles &files) const;
  const std::string &scene_text() const { return scene_; }

  /* The options that differ from their defaults, as they would be typed again; `broadphase` is the one that was used,
   * which auto does not say. */
  std::string typed_again(const std::string &broadphase) const;

private:
  std::string scene_, on_ = "tbb", place_, steps_ = "120", step_, substeps_, iterations_;
  std::string solver_, broadphase_, bounds_, midphase_, narrowphase_, support_, support_cells_, batching_, max_pairs_;
  bool no_specialise_ = false, inexact_ = false, check_ = false, events_ = false, outside_files_ = false;
};

} // namespace tandem
