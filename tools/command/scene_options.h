/* scene_options.h - the options for the scene and its simulation, which run, diff and plan share. */
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <tandem/backend.h>
#include <tandem/load_scene.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

#include "tools/command/distinct_files.h"

namespace tandem {

/* Parses an integer in [lowest, highest]; throws InputError that names the option. */
uint64_t whole_number(const std::string &option, const std::string &text, uint64_t lowest, uint64_t highest);
/* Parses any finite number that strtod accepts. */
double real_number(const std::string &option, const std::string &text);

/* --coordinates, for a text that is "maximal" at first; what it says, or InputError. */
void add_coordinates_option(CLI::App &parser, std::string &coordinates);
Coordinates coordinates_of(const std::string &text);

class SceneOptions {
public:
  /* `one_backend`: adds --on; diff takes its backends from another option. */
  SceneOptions(CLI::App &parser, bool one_backend);

  /* Adds a flag --events, for commands that compute events without writing them. */
  void add_events_flag(CLI::App &parser);

  /* These are for use after parsing. They throw InputError for the first invalid option. */
  Settings settings() const;
  Placement placement() const;
  uint64_t steps() const;
  std::optional<uint64_t> steps_given() const; /* none without --steps */
  /* Throws InputError also if one of `files` is an output and the scene is read from it. */
  Scene scene(DistinctFiles &files) const;
  const std::string &scene_text() const { return scene_; }

  /* The options that differ from their defaults, in the form of a command line. `broadphase` is the one that was used,
   * because `auto` does not name it. */
  std::string typed_again(const std::string &broadphase) const;

private:
  const bool one_backend_;
  const CLI::Option *steps_option_ = nullptr;
  std::string scene_, on_ = "tbb", place_, steps_ = "120", step_, substeps_, iterations_, joint_hertz_;
  std::string solver_, broadphase_, bounds_, midphase_, narrowphase_, support_, support_cells_, batching_, max_pairs_;
  std::string coordinates_ = "maximal";
  bool no_specialise_ = false, sleep_ = false, inexact_ = false, check_ = false, events_ = false,
       outside_files_ = false, tree_joint_forces_ = false;
};

} // namespace tandem
