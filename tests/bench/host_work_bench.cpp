// SPDX-License-Identifier: MIT
// What the host's program computes, as code of this computer: CPU time of each item that the machine description gives
// a cost to (docs/costs.md). Enters: nothing; leaves: time per item.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>
#include <tuple>
#include <vector>

#include "firmware/protocol/messages.hpp"
#include "host_tools/irradiance/cluster_light.hpp"
#include "host_tools/irradiance/irradiance_fit.hpp"
#include "host_tools/irradiance/vertex_irradiance.hpp"
#include "host_tools/layout/hemicube_weights.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/ray_tracing_phase.hpp"

namespace torolux::test {
namespace {

/// Seconds of an iteration over its items.
void per_item(benchmark::State& state, double items) {
  state.counters["per_item"] =
      benchmark::Counter(items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

struct Prepared {
  Scene scene;
  Quality quality;
  RenderSetup setup;
};

Prepared prepare(const char* name) {
  Prepared prepared;
  prepared.scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / name, {});
  const Image image = load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / "pe.elf");
  MachineChoice machine;
  prepared.setup =
      make_setup(prepared.scene, prepared.scene.camera.value_or(Camera{}), prepared.quality, machine, image);
  return prepared;
}

/// A port that takes what is sent into one buffer, as the copy into a message does.
class SinkPort final : public HostPort {
 public:
  Cycles now() const override { return 0; }
  unsigned pes() const override { return 1; }
  void begin_stage(std::string_view /*name*/) override {}
  void note(HostGauge /*gauge*/, double /*value*/) override {}
  void work(HostWork what, std::uint64_t items) override { done_[static_cast<std::size_t>(what)] += items; }
  void send_message(PeNumber, std::uint16_t, std::span<const std::byte> contents) override { put(contents); }
  void broadcast(std::uint16_t, std::span<const std::byte> contents) override { put(contents); }
  void send_records(PeNumber, std::span<const std::byte> records, std::uint32_t) override { put(records); }
  void read_pixels(const FrameRead&) override {}
  std::size_t queued(PeNumber) const override { return 0; }
  std::uint64_t done(HostWork what) const { return done_[static_cast<std::size_t>(what)]; }

 private:
  void put(std::span<const std::byte> bytes) {
    std::memcpy(buffer_.data(), bytes.data(), bytes.size());
    benchmark::DoNotOptimize(buffer_);
  }
  std::array<std::byte, protocol::kMostMessageBytes> buffer_{};
  std::array<std::uint64_t, kHostWorks> done_{};
};

/// Rays as the ray tracing stage makes them, walk and packet included.
void camera_rays(benchmark::State& state) {
  const Prepared prepared = prepare("cornell_box");
  const RenderSetup& setup = prepared.setup;
  constexpr std::uint64_t kRays = 20'000;
  for (auto _ : state) {
    state.PauseTiming();
    SinkPort port;
    RayTracingPhase phase(
        setup.placement,
        CameraRays(*prepared.scene.camera, setup.mesh.space, 512, 512, PixelSamples(PixelFilter::gaussian, 4, 1), 1),
        {kRays, 512, 512, 4, true});
    state.ResumeTiming();
    phase.start(port);
  }
  per_item(state, kRays);
}
BENCHMARK(camera_rays);

/// The walk alone, through a grid in which nothing is filled.
void subspaces(benchmark::State& state) {
  Grid grid = prepare("cornell_box").setup.placement.grid;
  const std::vector<bool> filled(std::size_t{grid.cells[0]} * grid.cells[1] * grid.cells[2], false);
  std::uint64_t entered = 0;
  std::uint32_t turn = 0;
  for (auto _ : state) {
    const float x = static_cast<float>(turn++ % 97) / 97.0F;
    benchmark::DoNotOptimize(
        first_subspace(grid, {x * 0.9F, 0.31F, 0.02F}, {0.4F - x, 0.3F, 0.86F}, &filled, &entered));
  }
  per_item(state, static_cast<double>(entered) / static_cast<double>(state.iterations()));
}
BENCHMARK(subspaces);

void sort_candidates(benchmark::State& state) {
  struct Chosen {
    PeNumber pe;
    protocol::Candidate candidate;
  };
  const auto count = static_cast<std::size_t>(state.range(0));
  std::mt19937 random(1);
  std::vector<Chosen> all(count);
  for (Chosen& one : all) one.candidate.unshot = static_cast<std::int64_t>(random());
  for (auto _ : state) {
    std::vector<Chosen> sorted = all;
    std::sort(sorted.begin(), sorted.end(), [](const Chosen& a, const Chosen& b) {
      return std::tuple(-a.candidate.unshot, a.candidate.number, a.candidate.side) <
             std::tuple(-b.candidate.unshot, b.candidate.number, b.candidate.side);
    });
    benchmark::DoNotOptimize(sorted);
  }
  per_item(state, static_cast<double>(count * static_cast<std::size_t>(std::bit_width(count - 1))));
}
BENCHMARK(sort_candidates)->Arg(64)->Arg(1024);

/// What is left to do once the elements' flux is known.
void irradiance(benchmark::State& state, const char* scene) {
  const Prepared prepared = prepare(scene);
  const IrradiancePlan plan(prepared.setup.mesh);
  const std::vector<protocol::Flux> flux(prepared.setup.mesh.elements, protocol::Flux{1000, 2000, 3000});
  std::size_t triangles = 0;
  for (auto _ : state) {
    const VertexIrradiance made = make_vertex_irradiance(plan, flux, 1e-12, 1);
    triangles = made.triangles.size();
  }
  per_item(state, static_cast<double>(triangles));
}
BENCHMARK_CAPTURE(irradiance, cornell_box, "cornell_box");
BENCHMARK_CAPTURE(irradiance, interior, "interior");

/// All that a vertex of a cluster takes, on a scene that has some.
void cluster_light(benchmark::State& state) {
  const Prepared prepared = prepare("interior");
  const IrradiancePlan plan(prepared.setup.mesh);
  const std::vector<protocol::Flux> flux(prepared.setup.mesh.elements, protocol::Flux{1000, 2000, 3000});
  for (auto _ : state) {
    for (const SidePlan& side : plan.side) benchmark::DoNotOptimize(ClusterLight(side.clusters, flux));
  }
  per_item(state, static_cast<double>(plan.side[0].clusters.fits() + plan.side[1].clusters.fits()));
}
BENCHMARK(cluster_light);

/// From a dozen clusters, as cluster_vertices.cpp finds them.
void irradiance_fit(benchmark::State& state) {
  std::mt19937 random(1);
  const auto part = [&random] { return static_cast<double>(random() % 1000) / 1000; };
  std::vector<IrradianceSample> samples(12);
  for (IrradianceSample& sample : samples) {
    sample = {{part(), part(), 0.9}, {part(), part(), part()}, {part(), part(), part()}, part()};
  }
  for (auto _ : state) benchmark::DoNotOptimize(fit_irradiance(samples));
  per_item(state, 1);
}
BENCHMARK(irradiance_fit);

void layout(benchmark::State& state) {
  const Prepared prepared = prepare("interior");
  const RenderSetup& setup = prepared.setup;
  std::size_t bytes = 0;
  for (auto _ : state) {
    bytes = 0;
    for (unsigned pe = 0; pe < setup.placement.torus.pes(); ++pe) {
      const auto number = static_cast<protocol::PeNumber>(pe);
      const PeLayout made =
          lay_out(setup.mesh, setup.placement, number, protocol::Stage::radiosity, setup.parameters, setup.map);
      bytes += radiosity_image(prepared.scene, setup.mesh, setup.placement, number, setup.units, made).size();
    }
  }
  per_item(state, static_cast<double>(host_lines(bytes)));
}
BENCHMARK(layout);

/// Elements from the bytes of PEs to the solution.
void unpack(benchmark::State& state) {
  constexpr std::size_t kElements = 100'000;
  std::vector<std::byte> bytes(kElements * sizeof(protocol::Element));
  std::vector<std::array<protocol::Flux, 2>> solution(kElements);
  for (auto _ : state) {
    for (std::size_t e = 0; e < kElements; ++e) {
      protocol::Element element{};
      std::memcpy(&element, bytes.data() + e * sizeof element, sizeof element);
      solution[e * 7919 % kElements] = {element.flux, element.apart};
    }
    benchmark::DoNotOptimize(solution);
  }
  per_item(state, static_cast<double>(host_lines(bytes.size())));
}
BENCHMARK(unpack);

/// Into memory that no cache holds, as what a device reads or has written.
void copy(benchmark::State& state) {
  std::vector<std::byte> from(protocol::kMostMessageBytes);
  std::vector<std::byte> to(std::size_t{64} << 20U);
  std::size_t at = 0;
  for (auto _ : state) {
    std::memcpy(to.data() + at, from.data(), from.size());
    at = (at + from.size()) % (to.size() - from.size());
    benchmark::ClobberMemory();
  }
  per_item(state, static_cast<double>(host_lines(from.size())));
}
BENCHMARK(copy);

void hemicube_table(benchmark::State& state) {
  std::size_t entries = 0;
  for (auto _ : state) entries = make_hemicube_table(64).size();
  per_item(state, static_cast<double>(entries));
}
BENCHMARK(hemicube_table);

void filter_table(benchmark::State& state) {
  std::size_t entries = 0;
  for (auto _ : state) entries = PixelSamples(PixelFilter::gaussian, 4, 1).distances().size();
  per_item(state, static_cast<double>(entries));
}
BENCHMARK(filter_table);

}  // namespace
}  // namespace torolux::test
