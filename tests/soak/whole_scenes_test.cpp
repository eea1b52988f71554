// SPDX-License-Identifier: MIT
// Every scene of scenes/ as `torolux render` makes it by default, on both engines: the same picture, cycles and
// statistics to the last figure.
#include <gtest/gtest.h>

#include "host_tools/cli/resolve.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

class WholeScene : public testing::TestWithParam<std::string> {};

TEST_P(WholeScene, TranslatedIsQemuToTheLastFigure) {
  const Scene scene = load_scene(source_dir() / "scenes" / GetParam(), {});
  const Resolved resolved = resolve({}, scene);
  const auto render_on = [&](const char* engine) {
    MachineChoice machine = resolved.machine;
    machine.engine = engine;
    return render(scene, resolved.camera, resolved.quality, machine, {}, pe_image(), {});
  };
  const RenderResult translated = render_on("translated");
  const RenderResult qemu = render_on("qemu");
  EXPECT_EQ(bytes_of(translated.picture), bytes_of(qemu.picture));
  EXPECT_EQ(exact_figures(translated.figures), exact_figures(qemu.figures));
}
INSTANTIATE_TEST_SUITE_P(Names, WholeScene, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace torolux::test
