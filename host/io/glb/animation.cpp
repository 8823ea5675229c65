/* animation.cpp - writes GLB: header, JSON chunk, binary chunk (Khronos, glTF 2.0 specification, chapter 4); see
 * animation.h.
 *
 * The JSON is written directly to the file, because with a million bodies its text is hundreds of megabytes. The binary
 * chunk:
 *
 *   | meshes: positions, normals, indices | times | body: translations, rotations | next body … |
 *
 * A body whose shape has a pose of its own has two nodes: one that moves, and a child that has the mesh. */
#include "host/io/glb/animation.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tandem/round_to_float.h>

#include "host/geometry/geometry.h"
#include "host/io/glb/geometry.h"
#include "host/io/output_file.h"

namespace tandem {
struct FramePose {
  Vec3 position;
  Quat orientation;
};

/* The mesh of a shape in one of the colours. */
struct ColoredMesh {
  Shape shape;
  uint32_t color;
};

struct RecordedBody {
  std::string name;
  FramePose rest;  /* in the first frame */
  Vec3 scale;      /* from the mesh to the body's size */
  uint32_t mesh;   /* index into Recording::meshes */
  FramePose shape; /* in the body */
};

struct Recording {
  Recording(const std::string &target_path, uint32_t keep_every);

  [[noreturn]] void fail(const char *what) const
  {
    throw InputError(fmt::format("{}: {}: {}", path, what, std::strerror(errno ? errno : EIO)));
  }
  void put(const void *data, size_t bytes) { target.write({static_cast<const char *>(data), bytes}); }
  uint64_t pose_bytes(size_t body_count) const { return uint64_t(body_count) * times.size() * sizeof(FramePose); }

  std::string path;
  uint32_t stride;
  uint64_t added = 0;
  bool finished = false;
  OutputFile target;
  File spool;
  std::vector<float> times;
  std::vector<RecordedBody> bodies;
  std::vector<ColoredMesh> meshes;
  std::vector<uint32_t> moving; /* bodies that may move: all but fixed ones */
  std::vector<bool> moved;      /* parallel to moving */
  std::vector<FramePose> last;  /* parallel to moving */
};

namespace {

constexpr uint64_t most_bytes = 0xffffffffu; /* GLB lengths are 32 bits wide */
constexpr uint64_t block_bytes = 64u << 20;  /* memory for the transposition from frames to bodies */
constexpr uint32_t float_type = 5126, uint16_type = 5123, uint32_type = 5125, vertex_target = 34962,
                   index_target = 34963;

bool finite(const Vec3 &p, const Quat &q)
{
  return std::isfinite(p[0] + p[1] + p[2]) && std::isfinite(q[0] + q[1] + q[2] + q[3]);
}

/* The file format requires unit length more exactly than a long simulation keeps it. */
Quat normalized(const Quat &q)
{
  double length = std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
  if (!(length > 0)) return {0, 0, 0, 1};
  return {round_to_float(q[0] / length), round_to_float(q[1] / length), round_to_float(q[2] / length),
          round_to_float(q[3] / length)};
}

std::string text(std::span<const float> values) { return fmt::format("[{}]", fmt::join(values, ",")); }

/* Writes comma-separated items of a JSON array or object; without a file it only counts their bytes. */
class JsonStream {
public:
  explicit JsonStream(OutputFile *file) : file_(file) {}
  void raw(std::string_view text)
  {
    if (file_) file_->write(text);
    bytes_ += text.size();
    separator_ = "";
  }
  void item(std::string_view text)
  {
    raw(separator_);
    raw(text);
    separator_ = ",";
  }
  uint64_t bytes() const { return bytes_; }

private:
  OutputFile *file_;
  uint64_t bytes_ = 0;
  const char *separator_ = "";
};

struct View {
  uint64_t offset, bytes;
  uint32_t target; /* 0: none */
};

/* What distinguishes two meshes: the type alone if all shapes of that type share one. */
using MeshKey = std::tuple<ShapeType, Vec3, const ConvexHull *>;

MeshKey mesh_key(const Shape &shape)
{
  const bool size_matters = !has_unit_mesh(shape.type) && shape.type != ShapeType::hull;
  return {shape.type, size_matters ? shape.size : Vec3{0, 0, 0},
          shape.type == ShapeType::hull ? shape.hull.get() : nullptr};
}

/* 16 bits can index so many vertices, which is enough for most meshes. glTF does not allow 0xffff as an index. */
constexpr size_t most_short_vertices = 0xffff;

/* The meshes of the shapes in use, one after the other, with each part aligned to 4 bytes. */
struct Geometry {
  std::map<MeshKey, size_t> places;
  std::vector<DisplayMesh> meshes;
  std::vector<uint8_t> bytes;
  std::vector<View> views; /* three per mesh: positions, normals, indices */

  template <typename T> void append(const std::vector<T> &values, uint32_t target)
  {
    size_t offset = bytes.size(), size = values.size() * sizeof(T);
    views.push_back({offset, size, target});
    bytes.resize((offset + size + 3) / 4 * 4);
    std::memcpy(bytes.data() + offset, values.data(), size);
  }
  void add(const Shape &shape)
  {
    if (!places.emplace(mesh_key(shape), meshes.size()).second) return;
    DisplayMesh mesh = display_mesh(shape);
    append(mesh.positions, vertex_target);
    append(mesh.normals, vertex_target);
    if (mesh.positions.size() > most_short_vertices) append(mesh.indices, index_target);
    else append(std::vector<uint16_t>(mesh.indices.begin(), mesh.indices.end()), index_target);
    meshes.push_back(std::move(mesh));
  }
  size_t index_of(const Shape &shape) const { return places.at(mesh_key(shape)); }
};

std::string vec3_accessor(size_t view, const std::vector<Vec3> &values, bool bounds)
{
  Vec3 low = values[0], high = values[0];
  for (const Vec3 &v : values)
    for (size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], v[i]), high[i] = std::max(high[i], v[i]);
  std::string extra = bounds ? fmt::format(R"(,"min":{},"max":{})", text(low), text(high)) : "";
  return fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"VEC3"{}}})", view, float_type,
                     values.size(), extra);
}

/* The half extent of a half space's quad: twice the distance of the farthest body. */
float half_space_reach(const Scene &scene)
{
  float reach = 25;
  for (const Body &body : scene.bodies)
    if (scene.shapes[body.shape].type != ShapeType::half_space)
      for (double x : body.position) reach = std::max(reach, round_to_float(std::abs(x)));
  return 2 * reach;
}

Vec3 scale_of(const Shape &shape, float reach)
{
  if (shape.type == ShapeType::half_space) return {reach, 1, reach};
  if (shape.type == ShapeType::sphere) return {shape.size[0], shape.size[0], shape.size[0]};
  return has_unit_mesh(shape.type) ? shape.size : Vec3{1, 1, 1};
}

bool same_pose(const FramePose &a, const FramePose &b)
{
  return a.position == b.position && a.orientation == b.orientation;
}

uint32_t color_of(const Scene &scene, size_t index)
{
  const Body &body = scene.bodies[index];
  if (body.type == BodyType::fixed) return 0;
  if (body.type == BodyType::kinematic) return 1;
  constexpr auto moving_colors = uint32_t(palette.size()) - first_moving_color;
  /* Colours follow the material if there are several, otherwise the index, so that neighbours differ. */
  uint32_t key = scene.materials.size() > 1 ? body.material : uint32_t(index);
  return first_moving_color + key % moving_colors;
}

void collect_bodies(const Scene &scene, Recording &r)
{
  float reach = half_space_reach(scene);
  std::map<std::pair<MeshKey, uint32_t>, uint32_t> known;
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body &body = scene.bodies[i];
    const Shape &shape = scene.shapes[body.shape];
    ColoredMesh mesh{shape, color_of(scene, i)};
    auto [at, added] = known.emplace(std::pair{mesh_key(shape), mesh.color}, uint32_t(r.meshes.size()));
    if (added) r.meshes.push_back(mesh);
    r.bodies.push_back({body.name,
                        {rounded(body.position), normalized(body.orientation)},
                        scale_of(shape, reach),
                        at->second,
                        {body.shape_position, normalized(body.shape_orientation)}});
    if (body.type == BodyType::fixed) continue;
    r.moving.push_back(uint32_t(i));
    r.last.push_back(r.bodies.back().rest);
  }
  r.moved.resize(r.moving.size());
}

/* --- the JSON chunk ------------------------------------------------------------------------------ */

/* Views and accessors have the same indices up to the times: three per mesh, then the times. One more view holds all
 * poses, with two accessors per animated body. */
struct Layout {
  Geometry geometry;
  std::vector<uint32_t> animated; /* indices into Recording::moving of the bodies that moved */
  uint64_t time_bytes, pose_bytes;

  uint64_t times_at() const { return geometry.bytes.size(); }
  uint64_t poses_at() const { return times_at() + time_bytes; }
  uint64_t binary_bytes() const { return poses_at() + pose_bytes; }
  size_t times_accessor() const { return geometry.views.size(); }
};

Layout layout_of(const Recording &r)
{
  Layout layout;
  for (const ColoredMesh &mesh : r.meshes) layout.geometry.add(mesh.shape);
  for (uint32_t k = 0; k < r.moved.size(); ++k)
    if (r.moved[k]) layout.animated.push_back(k);
  layout.time_bytes = layout.animated.empty() ? 0 : 4 * r.times.size();
  layout.pose_bytes = r.pose_bytes(layout.animated.size());
  return layout;
}

constexpr FramePose no_pose{{0, 0, 0}, {0, 0, 0, 1}};

/* The nodes of bodies have the bodies' indices; those of shapes with a pose come after them. */
void write_nodes(JsonStream &json, const Recording &r)
{
  json.raw(R"(,"scene":0,"scenes":[{"nodes":[)");
  for (size_t i = 0; i < r.bodies.size(); ++i) json.item(fmt::format("{}", i));
  json.raw(R"(]}],"nodes":[)");
  std::vector<size_t> posed;
  for (size_t i = 0; i < r.bodies.size(); ++i) {
    const RecordedBody &body = r.bodies[i];
    std::string name = body.name.empty() ? fmt::format("body {}", i) : body.name;
    std::string looks = fmt::format(R"("mesh":{})", body.mesh), scale = fmt::format(R"(,"scale":{})", text(body.scale));
    if (!same_pose(body.shape, no_pose)) {
      looks = fmt::format(R"("children":[{}])", r.bodies.size() + posed.size());
      scale.clear();
      posed.push_back(i);
    }
    json.item(fmt::format(R"({{"name":{},{},"translation":{},"rotation":{}{}}})",
                          nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), looks,
                          text(body.rest.position), text(body.rest.orientation), scale));
  }
  for (size_t i : posed) {
    const RecordedBody &body = r.bodies[i];
    json.item(fmt::format(R"({{"mesh":{},"translation":{},"rotation":{},"scale":{}}})", body.mesh,
                          text(body.shape.position), text(body.shape.orientation), text(body.scale)));
  }
  json.raw("]");
}

void write_meshes(JsonStream &json, const Recording &r, const Geometry &geometry)
{
  json.raw(R"(,"materials":[)");
  for (const auto &color : palette)
    json.item(fmt::format(
        R"({{"pbrMetallicRoughness":{{"baseColorFactor":[{},{},{},1],"metallicFactor":0,"roughnessFactor":0.7}}}})",
        color[0], color[1], color[2]));
  json.raw(R"(],"meshes":[)");
  for (const ColoredMesh &mesh : r.meshes) {
    size_t first = 3 * geometry.index_of(mesh.shape);
    json.item(
        fmt::format(R"({{"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{}}},"indices":{},"material":{}}}]}})",
                    first, first + 1, first + 2, mesh.color));
  }
  json.raw("]");
}

void write_views(JsonStream &json, const Layout &layout)
{
  json.raw(fmt::format(R"(,"buffers":[{{"byteLength":{}}}],"bufferViews":[)", layout.binary_bytes()));
  for (const View &view : layout.geometry.views)
    json.item(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{},"target":{}}})", view.offset, view.bytes,
                          view.target));
  if (!layout.animated.empty()) {
    json.item(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", layout.times_at(), layout.time_bytes));
    json.item(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", layout.poses_at(), layout.pose_bytes));
  }
  json.raw("]");
}

void write_accessors(JsonStream &json, const Recording &r, const Layout &layout)
{
  size_t frames = r.times.size(), times = layout.times_accessor();
  json.raw(R"(,"accessors":[)");
  for (size_t at = 0; at < layout.geometry.meshes.size(); ++at) {
    const DisplayMesh &mesh = layout.geometry.meshes[at];
    json.item(vec3_accessor(3 * at, mesh.positions, true));
    json.item(vec3_accessor(3 * at + 1, mesh.normals, false));
    json.item(fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"SCALAR"}})", 3 * at + 2,
                          mesh.positions.size() > most_short_vertices ? uint32_type : uint16_type,
                          mesh.indices.size()));
  }
  if (!layout.animated.empty())
    json.item(fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"SCALAR","min":[{}],"max":[{}]}})",
                          times, float_type, frames, r.times.front(), r.times.back()));
  for (size_t k = 0; k < layout.animated.size(); ++k) {
    uint64_t offset = r.pose_bytes(k);
    const char *form = R"({{"bufferView":{},"byteOffset":{},"componentType":{},"count":{},"type":"{}"}})";
    json.item(fmt::format(fmt::runtime(form), times + 1, offset, float_type, frames, "VEC3"));
    json.item(fmt::format(fmt::runtime(form), times + 1, offset + sizeof(Vec3) * frames, float_type, frames, "VEC4"));
  }
  json.raw("]");
}

void write_animation(JsonStream &json, const Recording &r, const Layout &layout)
{
  if (layout.animated.empty()) return;
  size_t times = layout.times_accessor(), samplers = 2 * layout.animated.size();
  json.raw(R"(,"animations":[{"name":"simulation","samplers":[)");
  for (size_t s = 0; s < samplers; ++s)
    json.item(fmt::format(R"({{"input":{},"output":{},"interpolation":"LINEAR"}})", times, times + 1 + s));
  json.raw(R"(],"channels":[)");
  for (size_t s = 0; s < samplers; ++s)
    json.item(fmt::format(R"({{"sampler":{},"target":{{"node":{},"path":"{}"}}}})", s, r.moving[layout.animated[s / 2]],
                          s % 2 ? "rotation" : "translation"));
  json.raw("]}]");
}

uint64_t write_json(const Recording &r, const Layout &layout, OutputFile *file)
{
  JsonStream json(file);
  json.raw(R"({"asset":{"version":"2.0","generator":"Tandem"})");
  if (!r.bodies.empty()) { /* empty arrays are not allowed */
    write_nodes(json, r);
    write_meshes(json, r, layout.geometry);
    write_views(json, layout);
    write_accessors(json, r, layout);
    write_animation(json, r, layout);
  }
  json.raw("}");
  return json.bytes();
}

/* The length precedes the text, so the text is generated twice: a pipe cannot seek back, and the text may be too large
 * to keep in memory. */
void write_json_chunk(Recording &r, const Layout &layout)
{
  const uint64_t length = write_json(r, layout, nullptr), padding = (4 - length % 4) % 4;
  std::array<uint32_t, 5> header{0x46546c67, 2, 0, 0, 0x4e4f534a}; /* "glTF", version, length; length, "JSON" */
  const uint64_t total = sizeof header + length + padding + (layout.binary_bytes() > 0 ? 8 + layout.binary_bytes() : 0);
  if (total > most_bytes)
    throw InputError(fmt::format("{}: {} bytes do not fit into the 4 GiB of a .glb; keep fewer frames", r.path, total));
  header[2] = uint32_t(total);
  header[3] = uint32_t(length + padding);
  r.put(header.data(), sizeof header);
  write_json(r, layout, &r.target);
  r.target.write(std::string_view("   ", padding));
}

/* --- the poses ----------------------------------------------------------------------------------- */

/* q and -q are the same rotation; interpolation takes the short way only if the signs agree. */
Quat nearer_sign(Quat q, const Quat &before)
{
  if (q[0] * before[0] + q[1] * before[1] + q[2] * before[2] + q[3] * before[3] < 0)
    for (float &x : q) x = -x;
  return q;
}

/* Reads the poses of one frame of the bodies from moving[low] on. */
void read_row(const Recording &r, size_t frame, size_t low, std::vector<FramePose> &row)
{
  errno = 0;
  auto at = off_t((frame * r.moving.size() + low) * sizeof(FramePose));
  if (fseeko(r.spool.get(), at, SEEK_SET) != 0 ||
      std::fread(row.data(), sizeof(FramePose), row.size(), r.spool.get()) != row.size())
    r.fail("cannot read back the recorded frames");
}

/* Transposes frames of bodies to bodies of frames, as many bodies at a time as fit into a block. */
void write_poses(Recording &r, const Layout &layout)
{
  const std::vector<uint32_t> &animated = layout.animated;
  const size_t frames = r.times.size(),
               per_block = std::max<size_t>(1, size_t(block_bytes / (frames * sizeof(FramePose))));
  for (size_t begin = 0; begin < animated.size(); begin += per_block) {
    size_t bodies = std::min(per_block, animated.size() - begin), low = animated[begin];
    std::vector<FramePose> row(animated[begin + bodies - 1] - low + 1);
    std::vector<Vec3> translations(bodies * frames);
    std::vector<Quat> rotations(bodies * frames);
    for (size_t frame = 0; frame < frames; ++frame) {
      read_row(r, frame, low, row);
      for (size_t k = 0; k < bodies; ++k) {
        const FramePose &pose = row[animated[begin + k] - low];
        size_t at = k * frames + frame;
        translations[at] = pose.position;
        rotations[at] = frame == 0 ? pose.orientation : nearer_sign(pose.orientation, rotations[at - 1]);
      }
    }
    for (size_t k = 0; k < bodies; ++k) {
      r.put(translations.data() + k * frames, frames * sizeof(Vec3));
      r.put(rotations.data() + k * frames, frames * sizeof(Quat));
    }
  }
}

} // namespace

/* --- opening and closing --------------------------------------------------------------------- */

AnimationWriter::AnimationWriter(const Scene &scene, const std::string &path, uint32_t stride)
{
  if (path.size() < 4 || path.compare(path.size() - 4, 4, ".glb") != 0)
    throw InputError(fmt::format("{}: an animation is written as .glb; name the file so", path));
  if (stride == 0) throw InputError(fmt::format("{}: a stride of 0 keeps no frame; at least 1 is needed", path));
  recording_ = std::make_unique<Recording>(path, stride);
  collect_bodies(scene, *recording_);
}

AnimationWriter::~AnimationWriter() = default;

Recording::Recording(const std::string &target_path, uint32_t keep_every)
    : path(target_path), stride(keep_every), target(path, path), spool(nameless_file_beside(path))
{
  if (!spool) fail("cannot write the frames that wait for the end");
}

/* --- recording --------------------------------------------------------------------------------- */

size_t AnimationWriter::frame_count() const { return recording_->times.size(); }

void AnimationWriter::add_frame(double time, std::span<const Vec3> positions, std::span<const Quat> orientations)
{
  Recording &r = *recording_;
  if (positions.size() != r.bodies.size() || orientations.size() != r.bodies.size())
    throw InputError(fmt::format("{}: a frame of {} positions and {} orientations; the scene has {} bodies", r.path,
                                 positions.size(), orientations.size(), r.bodies.size()));
  if (r.finished) throw std::logic_error("a frame after finish()");
  if (r.added++ % r.stride != 0) return;
  if (!std::isfinite(time) || (!r.times.empty() && !(round_to_float(time) > r.times.back())))
    throw InputError(
        fmt::format("{}: frame {} at {} s does not come after the one before", r.path, r.times.size(), time));
  bool first = r.times.empty();
  r.times.push_back(round_to_float(time));
  /* Half of the bytes are reserved for the JSON, whose size is not known before the end. */
  if (r.pose_bytes(r.moving.size()) > most_bytes / 2)
    throw InputError(
        fmt::format("{}: {} frames of {} moving bodies do not fit into the 4 GiB of a .glb; keep fewer frames", r.path,
                    r.times.size(), r.moving.size()));
  for (size_t k = 0; k < r.moving.size(); ++k) {
    uint32_t body = r.moving[k];
    if (finite(positions[body], orientations[body])) r.last[k] = {positions[body], normalized(orientations[body])};
    if (first) r.bodies[body].rest = r.last[k];
    if (!same_pose(r.last[k], r.bodies[body].rest)) r.moved[k] = true;
  }
  errno = 0;
  if (std::fwrite(r.last.data(), sizeof(FramePose), r.last.size(), r.spool.get()) != r.last.size())
    r.fail("cannot write the frames that wait for the end");
}

void AnimationWriter::finish()
{
  Recording &r = *recording_;
  if (r.finished) return;
  Layout layout = layout_of(r);
  write_json_chunk(r, layout);
  if (layout.binary_bytes() > 0) {
    std::array<uint32_t, 2> header{uint32_t(layout.binary_bytes()), 0x004e4942}; /* length, "BIN" */
    r.put(header.data(), sizeof header);
    r.put(layout.geometry.bytes.data(), layout.geometry.bytes.size());
  }
  if (!layout.animated.empty()) {
    r.put(r.times.data(), 4 * r.times.size());
    write_poses(r, layout);
  }
  r.target.commit();
  r.finished = true;
}

} // namespace tandem
