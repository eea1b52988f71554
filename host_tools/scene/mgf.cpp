// SPDX-License-Identifier: MIT
// Carries out the statements of MGF files, one after the other.
#include "host_tools/scene/mgf.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/mgf_colours.hpp"
#include "host_tools/scene/mgf_lamp.hpp"
#include "host_tools/scene/mgf_surfaces.hpp"
#include "host_tools/scene/plain_text.hpp"

namespace torolux {
namespace {

class MgfReader {
 public:
  MgfReader(ImportedMesh& mesh, SceneFiles& files, Notices& notices, const MgfLimits& limits)
      : mesh_(mesh),
        files_(files),
        notices_(notices),
        materials_(mesh, notices),
        surfaces_(mesh, materials_, vertices_, notices, limits.triangles),
        limits_(limits) {}

  void run(const std::filesystem::path& path, const Place& asked_at) {
    run_file(path, asked_at);
    surfaces_.finish();
  }

 private:
  static constexpr std::size_t kMostDepth = 100;

  void run_file(const std::filesystem::path& path, const Place& asked_at) {
    const std::string name = path.lexically_normal().string();
    if (std::ranges::find(running_, name) != running_.end())
      refuse(asked_at, "'" + name + "' includes itself, by way of " + std::to_string(running_.size()) + " files");
    if (running_.size() == kMostDepth)
      refuse(asked_at, "more than 100 files that include one another; join some of them");
    auto entry = texts_.find(name);
    if (entry == texts_.end()) {
      std::string text = plain_text(files_.read(path, asked_at, kMostMeshBytes), name, notices_);
      entry = texts_.try_emplace(name, std::move(text), name, notices_).first;
    }
    running_.push_back(name);
    run_statements(entry->second);
    running_.pop_back();
  }

  void run_statements(const MgfText& text) {
    const std::size_t outside = transforms_.depth();
    std::vector<std::size_t> begins;  // of the open transforms: the statement after xf
    for (std::size_t i = 0; i < text.size() || !begins.empty();) {
      const bool ends = i == text.size();
      if (ends) notices_.note("a transform (xf) that is not closed ends with its file", {text.file(), 0});
      const MgfStatement statement = ends ? MgfStatement(text.file(), 0, kEnd) : text.statement(i);
      std::size_t& done = done_[&text];
      if (i >= done) {
        done = i + 1;
      } else {
        count_repeated(statement);
      }
      if (running_.size() == 1 && !ends) line_ = statement.line();
      ++i;
      if (statement.keyword() != "xf") {
        handle(statement);
      } else if (statement.count() > 0) {
        transforms_.open(statement, 0);
        begins.push_back(i);
      } else if (transforms_.depth() == outside) {
        statement.refuse_with("xf without arguments closes a transform, but none is open in this file");
      } else if (transforms_.next_copy()) {
        i = begins.back();
      } else {
        begins.pop_back();
        if (ends) i = text.size();
      }
    }
  }

  /// Arrays of arrays, and files that include others twice, can ask for more work than a life has time for.
  void count_repeated(const MgfStatement& statement) {
    repeated_ += 1 + statement.count() / kWordsOfOne;
    if (repeated_ > limits_.repeated)
      statement.refuse_with("arrays (-a) and files that are included again repeat more than " +
                            std::to_string(limits_.repeated) + " statements; make them smaller");
  }

  /// The innermost transform's next copy, of what one statement places.
  bool next_copy(const MgfStatement& statement) {
    count_repeated(statement);
    return transforms_.next_copy();
  }

  void handle(const MgfStatement& statement) {
    const std::string_view keyword = statement.keyword();
    if (MgfVertices::knows(keyword)) {
      vertices_.handle(statement);
    } else if (MgfSurfaces::knows(keyword)) {
      surfaces_.handle(statement, transforms_.current(), line_);
    } else if (MgfMaterials::knows(keyword)) {
      materials_.handle(statement, colours_.current());
    } else if (MgfColours::knows(keyword)) {
      colours_.handle(statement);
    } else if (keyword == "i") {
      include(statement);
    } else if (keyword == "ies") {
      hang_lamp(statement);
    } else if (keyword != "o") {
      note_unknown(statement);
    }
  }

  static std::filesystem::path folder_of(const MgfStatement& statement) {
    return std::filesystem::path(statement.file()).parent_path();
  }

  void include(const MgfStatement& statement) {
    if (statement.count() == 0) statement.refuse_with("'i' names no file; it is written i FILE [TRANSFORM]");
    const std::string name(statement.word(0));
    const std::array<std::filesystem::path, 1> folder{folder_of(statement)};
    const auto found = find_file(name, folder, files_, statement.place());
    if (!found) statement.refuse_with("there is no file " + in_quotes((folder[0] / name).string()) + " to include");
    if (!found->as_written)
      notices_.note("a file is found under another name", statement.place(),
                    in_quotes(name) + " is " + in_quotes(found->path.string()));
    if (statement.count() == 1) return run_file(found->path, statement.place());
    transforms_.open(statement, 1);
    do run_file(found->path, statement.place());
    while (next_copy(statement));
  }

  void hang_lamp(const MgfStatement& statement) {
    const MgfLamp lamp(statement, folder_of(statement), files_, notices_);
    const auto line = static_cast<std::uint32_t>(line_);
    if (lamp.transform() == statement.count()) return lamp.hang(transforms_.current(), line, limits_.triangles, mesh_);
    transforms_.open(statement, lamp.transform());
    do lamp.hang(transforms_.current(), line, limits_.triangles, mesh_);
    while (next_copy(statement));
  }

  void note_unknown(const MgfStatement& statement) {
    notices_.note("an entity that MGF does not have is passed over", statement.place(), in_quotes(statement.keyword()));
  }

  static constexpr std::array<std::string_view, 1> kEnd{"xf"};
  static constexpr std::size_t kWordsOfOne = 64;  ///< a longer statement counts as several

  ImportedMesh& mesh_;
  SceneFiles& files_;
  Notices& notices_;
  MgfColours colours_;
  MgfVertices vertices_;
  MgfMaterials materials_;
  MgfSurfaces surfaces_;
  MgfTransforms transforms_;
  const MgfLimits limits_;
  std::map<std::string, MgfText> texts_;
  std::vector<std::string> running_;                      ///< the files that include each other, the innermost last
  std::unordered_map<const MgfText*, std::size_t> done_;  ///< statements that have been carried out at least once
  std::size_t repeated_ = 0, line_ = 0;
};

}  // namespace

ImportedMesh import_mgf(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, Notices& notices,
                        const MgfLimits& limits) {
  ImportedMesh mesh;
  mesh.file = path.string();
  MgfReader(mesh, files, notices, limits).run(path, asked_at);
  return mesh;
}

}  // namespace torolux
