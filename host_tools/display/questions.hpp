// SPDX-License-Identifier: MIT
// A page's question about an element, a PE or a pixel enters; its answer leaves as JSON, from the session that has
// stayed after its run (docs/inspect.md).
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "host_tools/inspect/inspector.hpp"
#include "host_tools/render/session.hpp"

namespace torolux {

/// Of each question, which are objects: "element": N or [column, row]; "pe": N; "pixel": [column, row] or
/// [column, row, sample]. All are answered with an object that has the same key; or "error", in words.
class Questions {
 public:
  /// session: its first run has ended, and stays. All outlive this.
  Questions(const Scene& scene, const Quality& quality, const MachineChoice& machine, RenderSession& session);

  /// Whether the answer takes a view of the session, which overwrites its frame buffer.
  static bool asks_machine(const nlohmann::json& question);
  /// camera: from which the picture is seen now. wanted: as RenderSession::view; false: the answer is an error.
  nlohmann::ordered_json answer(const nlohmann::json& question, const Camera& camera,
                                const std::function<bool()>& wanted);
  /// Is on the page now, seen by `camera`.
  void take(const Picture& picture) { picture_ = picture; }

 private:
  const Inspector& inspector(const Camera& camera);
  nlohmann::ordered_json element(const nlohmann::json& value, const Camera& camera);
  nlohmann::ordered_json pe(const nlohmann::json& value, const Camera& camera);
  nlohmann::ordered_json pixel(const nlohmann::json& value, const Camera& camera, const std::function<bool()>& wanted);

  const Scene& scene_;
  const Quality& quality_;
  const MachineChoice& machine_;
  RenderSession& session_;
  MachineFigures figures_;  // of the first run
  Picture picture_;
  Camera camera_;                       // the inspector's
  std::optional<Inspector> inspector_;  // made for the first question from there
};

}  // namespace torolux
