/* animation.h - a simulation as one binary glTF file, to be watched in any glTF viewer.
 *
 * One node per body; one keyframe per recorded step for each body that moved. The result is body by
 * body in the file while the simulation delivers frame by frame, so frames wait in a file beside the
 * target, in one without a name, until finish() turns them over block by block; memory stays at a few tens of bytes a
 * body, however long the recording.
 *
 *   add_frame: |b0 b1 b2 …|b0 b1 b2 …|   ->   finish: | b0: t t t …, q q q … | b1: … |
 *                 frame 0     frame 1
 */
#pragma once

#include <memory>
#include <span>
#include <string>

#include <tandem/scene.h>

namespace tandem {

struct Recording; /* what is kept until finish(); animation.cpp */

class AnimationWriter {
public:
  /* `path` must end in .glb; a place that cannot be written throws InputError before the simulation runs. Of the frames
   * added, every `stride`-th is kept, from the first on. */
  AnimationWriter(const Scene &scene, const std::string &path, uint32_t stride = 1);
  /* Without finish(), what stood at `path` stands there still. */
  ~AnimationWriter();
  AnimationWriter(const AnimationWriter &) = delete;
  AnimationWriter &operator=(const AnimationWriter &) = delete;

  /* Time in seconds, rising from frame to frame; one pose per body of the scene. A pose that is not
   * finite repeats the last finite one. Throws InputError when the disk is full or the file would
   * pass the 4 GiB that the format holds. */
  void add_frame(double time, std::span<const Vec3> positions, std::span<const Quat> orientations);

  /* Writes the file; a second call does nothing. Throws InputError when it cannot be written. */
  void finish();

  size_t frame_count() const;

private:
  std::unique_ptr<Recording> recording_;
};

} // namespace tandem
