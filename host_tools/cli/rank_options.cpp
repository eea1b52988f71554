// SPDX-License-Identifier: MIT
// All ranks have the same command line; rank 0 alone does what it says.
#include "host_tools/cli/rank_options.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "emulator/errors.hpp"
#include "emulator/ranks/launched.hpp"
#include "emulator/ranks/mpi_ranks.hpp"
#include "emulator/ranks/starter.hpp"
#include "emulator/remote/serve_pes.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/files/digest.hpp"

namespace torolux {

void add_rank_options(CLI::App& command, RankOptions& options, const std::string& group) {
  static const std::map<std::string, remote::Placing> kNames = {
      {"block", remote::Placing::block}, {"cyclic", remote::Placing::cyclic}, {"random", remote::Placing::random}};
  CLI::Option* const placing =
      command
          .add_option_function<std::string>(
              "--placing", [&options](const std::string& name) { options.placing = kNames.at(name); },
              "With --ranks or mpirun: which rank runs which PE: block (neighbours together), cyclic or random; no "
              "result depends on it [block]")
          ->type_name("NAME")
          ->check(CLI::IsMember({"block", "cyclic", "random"}));
  if (!group.empty()) placing->group(group);
}

int run_on_ranks(const RankOptions& options, const std::function<int(remote::PeRanks*)>& work) {
  if (ranks::launched_ranks().count == 1) return work(nullptr);
  const std::unique_ptr<ranks::Transport> transport = ranks::join_mpi();
  const std::string program = sha256_of_file("/proc/self/exe");
  if (transport->ranks().own != 0) {
    remote::serve_pes(*transport, program);
    forget_interruption();  // rank 0 knows of it, and its exit code counts
    return 0;
  }
  remote::PeRanks others(*transport, options.placing, program);
  // What goes wrong is told before the others end: where one of them is lost, they take this process along.
  const int code = guarded([&] { return work(&others); });
  ranks::tell_starter(code);  // the work is done, whatever becomes of ranks from now on
  others.end(code);
  return code;
}

void refuse_on_ranks(bool given, const std::string& option) {
  if (given) throw UsageError(option + " does not go with PEs on other ranks: leave out --ranks, or mpirun");
}

}  // namespace torolux
