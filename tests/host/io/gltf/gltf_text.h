/* gltf_text.h - small glTF files as text, for the tests of their reader, and the scenes that it makes of them. */
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <Eigen/Dense>
#include <unistd.h>

#include "host/io/gltf/scene.h"

namespace tandem::gltf_text {

namespace fs = std::filesystem;

/* The name is unique to the process, because tests of one tree run at the same time, each in its own process. */
inline const std::string temporary_path =
    (fs::temp_directory_path() / ("tandem_scene_" + std::to_string(getpid()) + ".gltf")).string();

/* A .gltf file that lives as long as the object. */
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string &text, const std::string &name = temporary_path) : path(name)
  {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::remove(path.c_str()); }
};

struct Parts {
  std::string nodes; /* JSON array items */
  std::string shapes =
      R"({"type":"box","box":{}},{"type":"sphere","sphere":{}},{"type":"plane"})"; /* 0 box, 1 sphere, 2 plane */
  std::string document = ""; /* members of the rigid-body extension */
  std::string more = "";     /* further members of the file */
};

inline std::string gltf(const Parts &parts)
{
  return R"({"asset":{"version":"2.0"},"nodes":[)" + parts.nodes +
         R"(],"extensions":{"KHR_implicit_shapes":{"shapes":[)" + parts.shapes + R"(]},"KHR_physics_rigid_bodies":{)" +
         parts.document + "}}" + parts.more + "}";
}

inline Scene loaded(const Parts &parts)
{
  TemporaryFile file(gltf(parts));
  return read_scene_gltf(file.path);
}

inline std::string complaint(const Parts &parts)
{
  try {
    loaded(parts);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

/* The JSON of one node, called Cup, with the given motion members and shape. */
inline std::string cup(const std::string &motion, int shape = 0, const std::string &node = "")
{
  return R"({"name":"Cup",)" + node + R"("extensions":{"KHR_physics_rigid_bodies":{"motion":{)" + motion +
         R"(},"collider":{"geometry":{"shape":)" + std::to_string(shape) + "}}}}}";
}

inline std::string collider(int shape, const std::string &node = "", const std::string &more = "")
{
  return "{" + node + R"("extensions":{"KHR_physics_rigid_bodies":{"collider":{"geometry":{"shape":)" +
         std::to_string(shape) + "}" + more + "}}}}";
}

inline bool near(const Vec3 &v, double x, double y, double z)
{
  return (Eigen::Vector3d(v[0], v[1], v[2]) - Eigen::Vector3d(x, y, z)).norm() <
         1e-5 * (1 + Eigen::Vector3d(x, y, z).norm());
}

inline Eigen::Matrix3d rotation(const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix(); }

inline std::string base64(const std::string &bytes)
{
  static const char *digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63];
  }
  return text;
}

template <class T> std::string bytes_of(const std::vector<T> &values)
{
  return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T)};
}

/* The members of a file with one mesh. Its buffer holds positions, then indices of 16 bits. */
inline std::string with_mesh(const std::vector<Vec3> &points, const std::vector<uint16_t> &indices,
                             const std::string &primitive = "")
{
  const std::string bytes = bytes_of(points) + bytes_of(indices), split = std::to_string(12 * points.size());
  return R"(,"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":)" + split + R"(},{"buffer":0,"byteOffset":)" + split +
         R"(,"byteLength":)" + std::to_string(2 * indices.size()) +
         R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
         std::to_string(points.size()) +
         R"(,"min":[-9,-9,-9],"max":[9,9,9]},{"bufferView":1,"componentType":5123,"type":"SCALAR","count":)" +
         std::to_string(indices.size()) + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1)" +
         primitive + "}]}]";
}

inline const std::vector<Vec3> tip_points{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}};
inline const std::vector<uint16_t> tip_triangles{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

/* The JSON of a node called Cup, which is a body of the given geometry. node: further members. */
inline std::string cup_of(const std::string &geometry, const std::string &node = "",
                          const std::string &motion = R"("motion":{},)")
{
  return R"({"name":"Cup",)" + node + R"("extensions":{"KHR_physics_rigid_bodies":{)" + motion +
         R"("collider":{"geometry":{)" + geometry + "}}}}}";
}

} // namespace tandem::gltf_text
