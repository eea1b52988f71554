// SPDX-License-Identifier: MIT
// One view with all samples for each camera behind the first.
#include "host_tools/cli/path_frames.hpp"

#include <algorithm>
#include <string>

#include "host_tools/render/frame_layers.hpp"
#include "host_tools/scene/camera_path.hpp"
#include "host_tools/scene/files.hpp"

namespace torolux {
namespace {

constexpr std::size_t kLeastDigits = 4;

void write_frame(const Resolved& resolved, const Picture& picture, const std::vector<Layer>& layers,
                 std::size_t number) {
  for (const auto& file : resolved.outputs) {
    write_layers(picture, layers, frame_file(file, number, resolved.path.size()), resolved.tone);
  }
}

}  // namespace

std::vector<Camera> load_camera_path(const std::filesystem::path& file, const Camera& like) {
  return read_camera_path(DiskFiles().read(file, {}, kMostTextBytes), file.string(), like);
}

std::filesystem::path frame_file(const std::filesystem::path& file, std::size_t number, std::size_t of) {
  std::string digits = std::to_string(number);
  const std::size_t wanted = std::max(kLeastDigits, std::to_string(of).size());
  if (digits.size() < wanted) digits.insert(0, wanted - digits.size(), '0');
  std::filesystem::path name = file.stem();
  name += "." + digits;
  name += file.extension();
  return file.parent_path() / name;
}

void render_path(RenderSession& session, const Resolved& resolved, RenderResult& first,
                 const std::function<bool(std::size_t, std::size_t)>& tell) {
  const Quality& quality = resolved.quality;
  Cycles begin = first.figures.machine.now;
  first.figures.path.push_back({begin, first.figures.picture_sha256});
  write_frame(resolved, first.picture, first.layers, 1);
  for (std::size_t i = 1; i < resolved.path.size(); ++i) {
    if (!tell(i + 1, resolved.path.size())) return;
    const View view{resolved.path[i], quality.width, quality.height, {0, quality.samples, 1}};
    if (!session.view(view, [&] { return tell(i + 1, resolved.path.size()); })) return;
    const Cycles now = session.now();
    first.figures.path.push_back({now - begin, digest_of(session.frame_buffer(), protocol::Plane::colour)});
    begin = now;
    write_frame(resolved, session.picture(quality.samples), session.layers(), i + 1);
  }
}

}  // namespace torolux
