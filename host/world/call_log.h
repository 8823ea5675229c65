/* call_log.h - writes the calls of a program to a file while it runs; <tandem/recording.h> reads it.
 *
 *   8 bytes magic, uint64 format
 *   parts: uint64 bytes, uint64 hash (hash_blocks, seeded with the number of the part), then the bytes, which
 *          begin with their kind
 *     header     version of the library
 *     snapshot   steps made before it, and the bytes of World::save
 *     calls      the calls before a step, and the step with its hashes; one part a step, so that the file can be read
 *                until the step before a crash
 *     end        the number of steps
 *
 * A call that throws changes nothing and is not written. If the file cannot be written, the program goes on and the
 * recording ends; finish() says so.
 */
#pragma once

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include <tandem/recording.h>

#include "host/world/snapshot_fields.h"
#include "host/world/snapshot_scene.h"

namespace tandem {

constexpr std::array<char, 8> recording_magic{'T', 'A', 'N', 'D', 'E', 'M', 'R', '\n'};
constexpr uint64_t recording_format = 4;

enum class RecordedPart : uint8_t { header, snapshot, calls, end };

enum class RecordedCall : uint8_t {
  step,
  create_bodies,
  destroy_bodies,
  set_properties,
  add_shapes,
  remove_shapes,
  shapes_of,
  add_shape,
  add_material,
  set_body,
  set_states,
  set_velocities,
  move_to,
  add_impulses,
  add_forces,
  wake_bodies,
  set_gravity,
  restore,
  keep_states,
  keep_state,
  go_back,
  run,
  write,
  cast_rays_on_device, /* whose hits kernels of modules read */
  cast_shapes_on_device,
  create_joints,
  destroy_joints,
  set_joints,
  set_joint_axes
};

/* What is written after a step. */
struct StepHashes {
  std::optional<uint64_t> state;
  std::vector<uint32_t> bodies; /* by index; none in most steps of large worlds */
};

template <Is<StepHashes> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[state, bodies] = record;
  return visit(state, bodies);
}

/* A hash of the state of each body, by its index. */
std::vector<uint32_t> body_hashes(Memory &memory, const std::vector<uint32_t> &order);

class CallLog {
public:
  /* Throws InputError if the file cannot be opened. */
  CallLog(const std::string &path, const RecordingOptions &options);
  ~CallLog();

  const RecordingOptions &options() const { return options_; }
  uint64_t steps() const { return steps_; }
  template <class... T> void put(RecordedCall call, const T &...fields) noexcept
  {
    guarded([&] {
      begin_calls();
      writer_.put(call);
      (put_field(fields), ...);
    });
  }
  void end_step(const StepHashes &hashes) noexcept;
  void put_snapshot(std::span<const std::byte> bytes) noexcept;
  void fail(const std::string &why) noexcept;
  /* Throws InputError if any of it could not be written. */
  void finish();

private:
  struct Close {
    void operator()(std::FILE *file) const { std::fclose(file); }
  };
  template <class T> void put_field(const T &field) { writer_.put(field); }
  void put_field(const Shape &shape) { put_shape(writer_, shape); }
  void put_field(std::span<const Child> children) { put_children(writer_, children); }
  void put_field(std::span<const std::byte> bytes)
  {
    writer_.put(uint64_t{bytes.size()});
    writer_.put_bytes(bytes.data(), bytes.size());
  }
  void begin_calls();
  void write_part();
  void write(const void *bytes, size_t count);
  template <class Work> void guarded(const Work &work) noexcept
  {
    if (failed_) return;
    try {
      work();
    } catch (const std::exception &error) {
      fail(error.what());
    }
  }

  std::string path_, why_;
  std::unique_ptr<std::FILE, Close> file_;
  RecordingOptions options_;
  ByteWriter writer_; /* the part that is being made */
  uint64_t parts_ = 0, steps_ = 0;
  bool failed_ = false;
};

} // namespace tandem
