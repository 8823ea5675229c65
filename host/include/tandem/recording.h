/* recording.h - what a program did with a world, as a file that runs anywhere: a snapshot, each call with its
 * arguments, and a hash of the state after each step. World::start_recording writes it; a report of a defect is this
 * one file.
 *
 *   WorldRecording recording(bytes_of_file, "F.tandem");
 *   World world(recording.snapshot(), {"serial"});
 *   const std::optional<RecordedDifference> difference = replay(recording, world, {});
 *
 * A recording may be cut between two steps, for example because the program crashed: it then ends there, and finished()
 * is false. docs/recordings.md describes the file and the commands that read it.
 *
 * Several threads may replay at once, each into a world of its own.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tandem/export.h>

namespace tandem {

class World;

struct RecordingOptions {
  /* Steps between snapshots, from which a replay can start; 0: the first alone. There are none while the world keeps
   * states (World::keep_states). */
  uint64_t snapshot_every = 0;
  /* A hash of the state after each step, and of each body as often as takes 4 KiB a step (each step up to 1,024
   * bodies). Without them a replay cannot tell whether it is exact. */
  bool hashes = true;
};

/* The first step after which a replay had another state than the recording. Steps are counted from the beginning of the
 * recording, the first is 0. */
struct RecordedDifference {
  uint64_t step = 0;
  uint64_t recorded = 0, found = 0; /* World::state_hash */
  /* The first body that differs, by its index, in the first step from `step` on after which the recording has hashes of
   * bodies; none if they are equal there, as where the contact cache alone differs. */
  std::optional<uint32_t> body;
  uint64_t body_step = 0;
  std::string name; /* of the body */
};

class TANDEM_API WorldRecording {
public:
  /* bytes: of the file; where: its name, for messages. Throws InputError that says what is wrong unless each part is as
   * it was written. */
  WorldRecording(std::vector<std::byte> bytes, std::string where);
  ~WorldRecording();
  WorldRecording(WorldRecording &&) noexcept;
  WorldRecording &operator=(WorldRecording &&) noexcept;

  uint64_t steps() const;
  bool finished() const;              /* World::stop_recording wrote its end */
  const std::string &made_by() const; /* the version of Tandem */
  /* The last snapshot that was taken before this step, and the number of steps before it. */
  std::span<const std::byte> snapshot(uint64_t step = 0) const;
  uint64_t snapshot_step(uint64_t step) const;

  /* Makes the calls that were made before this step, or after the last one if step is steps(). Throws InputError if one
   * of them has another result than it had, which another version of Tandem may cause. */
  void make_calls(World &world, uint64_t step) const;
  bool has_hash(uint64_t step) const;
  bool has_body_hashes(uint64_t step) const;
  /* Compares the world after this step; nothing if it has no hash. */
  std::optional<RecordedDifference> difference(World &world, uint64_t step) const;

private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

struct ReplayRequest {
  uint64_t first = 0;       /* step that comes next in the world: snapshot_step() of its snapshot */
  uint64_t verify_from = 0; /* steps before it are made without being compared */
  bool verify = true;       /* false: the last step alone is compared */
  std::function<void(uint64_t done)> after_step = nullptr;
};

/* Makes all calls and steps of the recording until one differs; returns the difference. Throws as make_calls and
 * World::step do. */
TANDEM_API std::optional<RecordedDifference> replay(const WorldRecording &recording, World &world,
                                                    const ReplayRequest &request);

} // namespace tandem
