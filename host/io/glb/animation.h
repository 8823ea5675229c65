/* animation.h - writes a simulation as one binary glTF file, which any glTF viewer can show.
 *
 * There is one node per body, and one keyframe per recorded step for each body that moved. The file is ordered body by
 * body, while the simulation delivers frame by frame. Frames therefore wait in an unnamed temporary file in the
 * target's folder until finish() transposes them block by block; memory stays at a few tens of bytes a body, however
 * long the recording.
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

struct Recording; /* the state that is kept until finish(); animation.cpp */

class AnimationWriter {
public:
  /* `path` must end in .glb; a location that cannot be written throws InputError before the simulation runs. Of the
   * frames added, every `stride`-th is kept, from the first on. */
  AnimationWriter(const Scene &scene, const std::string &path, uint32_t stride = 1);
  /* Without finish(), the file at `path` is unchanged. */
  ~AnimationWriter();
  AnimationWriter(const AnimationWriter &) = delete;
  AnimationWriter &operator=(const AnimationWriter &) = delete;

  /* Adds a frame: the time in seconds, which must increase, and one pose per body of the scene. A pose that is not
   * finite repeats the last finite one. Throws InputError if the disk is full or the file would exceed the 4 GiB that
   * the format allows. */
  void add_frame(double time, std::span<const Vec3> positions, std::span<const Quat> orientations);

  /* Writes the file; a second call does nothing. Throws InputError if it cannot be written. */
  void finish();

  size_t frame_count() const;

private:
  std::unique_ptr<Recording> recording_;
};

} // namespace tandem
