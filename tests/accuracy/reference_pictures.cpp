// SPDX-License-Identifier: MIT
// Files are named by a hash of all that the picture depends on. A new one gets twice the paths, again and again, until
// its noise is low enough.
#include "tests/accuracy/reference_pictures.hpp"

#include <bit>
#include <cstdio>

#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/references/picture_error.hpp"

namespace torolux::accuracy {
namespace {

/// FNV-1a of all that the picture depends on.
class Hash {
 public:
  void add(std::uint64_t value) {
    for (unsigned shift = 0; shift < 64; shift += 8) {
      state_ = (state_ ^ ((value >> shift) & 0xFFU)) * 0x100000001B3U;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3d& v) {
    for (const double x : v) add(x);
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xCBF29CE484222325U;
};

void add_sky(const Sky& sky, Hash& hash) {
  for (const Vec3d& axis : {sky.east, sky.north, sky.up, sky.sun, sky.sun_irradiance}) hash.add(axis);
  for (const Vec3d& radiance : sky.radiance) hash.add(radiance);
}

void add_textures(const Scene& scene, Hash& hash) {
  for (const auto& [u, v] : scene.texture_points) {
    hash.add(u);
    hash.add(v);
  }
  for (const SceneTexture& texture : scene.textures) {
    hash.add(std::uint64_t{texture.width} << 32U | texture.height);
    for (const auto& [red, green, blue] : texture.texels)
      hash.add(std::uint64_t{red} << 16U | std::uint64_t{green} << 8U | blue);
  }
}

std::uint64_t hash_of(const Scene& scene, const View& view, const std::array<std::uint32_t, 2>& size,
                      const ReferenceEffort& effort) {
  Hash hash;
  for (const Vec3d& position : scene.positions) hash.add(position);
  for (const Vec3d& normal : scene.normals) hash.add(normal);
  for (const SceneTriangle& triangle : scene.triangles) {
    for (std::size_t i = 0; i < 3; ++i) hash.add(std::uint64_t{triangle.position[i]} << 32U | triangle.normal[i]);
    hash.add(std::uint64_t{triangle.material});
  }
  for (const SceneMaterial& material : scene.materials) {
    hash.add(static_cast<std::uint64_t>(material.kind));
    for (const Vec3d& v : {material.diffuse, material.specular, material.transmittance, material.emission}) hash.add(v);
    hash.add(material.refractive_index);
    if (material.lamp == kNoMeasuredLamp) continue;
    const SceneLamp& lamp = scene.lamps[material.lamp];
    for (const Vec3d& axis : {lamp.x, lamp.y, lamp.nadir}) hash.add(axis);
    for (const double intensity : scene.webs[lamp.web].intensity) hash.add(intensity);
  }
  add_textures(scene, hash);
  if (scene.sky) add_sky(*scene.sky, hash);
  hash.add(view.camera.eye);
  hash.add(view.camera.look_at);
  hash.add(view.camera.up);
  hash.add(view.camera.field_of_view_degrees);
  if (view.camera.aperture > 0) {
    hash.add(view.camera.aperture);
    hash.add(focus_distance(view.camera));
  }
  hash.add(std::uint64_t{view.two_sided_lights});
  hash.add(std::uint64_t{size[0]} << 32U | size[1]);
  hash.add(std::uint64_t{effort.first_samples} << 32U | effort.most_samples);
  hash.add(effort.noise);
  return hash.value();
}

/// There, and not older than the tracer.
bool holds(const std::filesystem::path& file) {
  return std::filesystem::exists(file) &&
         std::filesystem::last_write_time(file) >= std::filesystem::last_write_time(TOROLUX_REFERENCES_LIBRARY);
}

Picture mean_of(const Picture& a, const Picture& b) {
  Picture mean = a;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      mean.pixels[i][c] = (a.pixels[i][c] + b.pixels[i][c]) / 2;
    }
  }
  return mean;
}

references::TracedPicture trace_until_smooth(const references::World& world, const Camera& camera,
                                             references::TraceChoice choice, const ReferenceEffort& effort) {
  references::TracedPicture sum = references::trace(world, camera, choice);
  std::uint32_t done = choice.samples;
  while (references::reference_noise(sum) > effort.noise && done < effort.most_samples) {
    choice.samples = done;  // as many again
    ++choice.seed;
    const references::TracedPicture more = references::trace(world, camera, choice);
    sum = {mean_of(sum.picture, more.picture), mean_of(sum.first_half, more.first_half),
           mean_of(sum.second_half, more.second_half)};
    done *= 2;
    std::printf("%u paths per pixel: noise %.2f %%\n", done, 100 * references::reference_noise(sum));
    std::fflush(stdout);
  }
  return sum;
}

}  // namespace

references::TracedPicture reference_picture(const Scene& scene, const View& view,
                                            const std::array<std::uint32_t, 2>& size, const ReferenceEffort& effort,
                                            unsigned threads, const std::filesystem::path& folder) {
  std::array<char, 17> hash{};
  std::snprintf(hash.data(), hash.size(), "%016llx",
                static_cast<unsigned long long>(hash_of(scene, view, size, effort)));
  const std::filesystem::path first = folder / (scene.name + "-" + hash.data() + "-1.pfm");
  const std::filesystem::path second = folder / (scene.name + "-" + hash.data() + "-2.pfm");
  if (holds(first) && holds(second)) {
    references::TracedPicture kept{{}, read_picture(first), read_picture(second)};
    kept.picture = mean_of(kept.first_half, kept.second_half);
    return kept;
  }
  std::filesystem::create_directories(folder);
  references::TraceChoice choice;
  choice.width = size[0];
  choice.height = size[1];
  choice.samples = effort.first_samples;
  choice.threads = threads;
  choice.caustics = references::Caustics::from_light;
  const references::World world(scene, view.two_sided_lights);
  references::TracedPicture traced = trace_until_smooth(world, view.camera, choice, effort);
  write_picture(traced.first_half, first);
  write_picture(traced.second_half, second);
  return traced;
}

}  // namespace torolux::accuracy
