// SPDX-License-Identifier: MIT
// The six calls by MPI's: messages that are sent and received without waiting for the other side.
#include "emulator/ranks/mpi_ranks.hpp"

// Only the C interface: the C++ one is not in the standard any more.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <iostream>
#include <limits>
#include <list>
#include <mutex>
#include <thread>

#include "emulator/ranks/launched.hpp"
#include "emulator/ranks/starter.hpp"

namespace torolux::ranks {
namespace {

using Clock = std::chrono::steady_clock;

/// Under way; the bytes stay where they are until MPI has done with them.
struct Transfer {
  MPI_Request request = MPI_REQUEST_NULL;
  Message message;
  bool done = false;
};

class MpiRank : public Transport {
 public:
  MpiRank();
  ~MpiRank() override = default;

  Ranks ranks() const override { return ranks_; }
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override;
  std::optional<Message> poll() override;
  bool wait(std::chrono::milliseconds limit) override;
  [[noreturn]] void abort(const std::string& reason) override;
  void close(std::span<const unsigned> lost, int exit_code) override;

 private:
  void progress();
  void accept_messages();
  std::list<Transfer>::iterator next();

  Ranks ranks_;
  std::mutex mutex_;  ///< around each call of MPI (MPI_THREAD_SERIALIZED)
  std::list<Transfer> outgoing_, incoming_;
  Clock::time_point received_;  // the last message
};

MpiRank::MpiRank() {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  int own = 0;
  int count = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &own);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  ranks_ = {static_cast<unsigned>(own), static_cast<unsigned>(count)};
  // What was sent to a rank that is gone is lost; its silence tells.
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  if (provided < MPI_THREAD_SERIALIZED) abort("this MPI cannot be called by several threads in turn");
}

void MpiRank::send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw MachineFailure("a message to rank " + std::to_string(to) + " has more than 2 GiB");
  const std::lock_guard lock(mutex_);
  Transfer& transfer = outgoing_.emplace_back();
  transfer.message.bytes.assign(bytes.begin(), bytes.end());
  const int sent = MPI_Isend(transfer.message.bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE,
                             static_cast<int>(to), static_cast<int>(kind), MPI_COMM_WORLD, &transfer.request);
  if (sent != MPI_SUCCESS) outgoing_.pop_back();
  progress();
}

/// MPI moves messages only while it is called.
void MpiRank::progress() {
  outgoing_.remove_if([](Transfer& transfer) {
    int done = 0;
    return MPI_Test(&transfer.request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS || done != 0;
  });
}

/// Begins to receive all that has been announced: who sends a large message may die on the way, so nobody waits for it.
void MpiRank::accept_messages() {
  for (;;) {
    int there = 0;
    MPI_Message handle = MPI_MESSAGE_NULL;
    MPI_Status status;
    if (MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &handle, &status) != MPI_SUCCESS) break;
    if (there == 0) break;
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    Transfer& transfer = incoming_.emplace_back();
    transfer.message.from = static_cast<unsigned>(status.MPI_SOURCE);
    transfer.message.kind = static_cast<std::uint32_t>(status.MPI_TAG);
    transfer.message.bytes.resize(static_cast<std::size_t>(bytes));
    MPI_Imrecv(transfer.message.bytes.data(), bytes, MPI_BYTE, &handle, &transfer.request);
  }
  for (Transfer& transfer : incoming_) {
    if (transfer.done) continue;
    int done = 0;
    MPI_Test(&transfer.request, &done, MPI_STATUS_IGNORE);
    transfer.done = done != 0;
  }
}

/// The first that is whole and before which no other of its sender is awaited.
std::list<Transfer>::iterator MpiRank::next() {
  for (auto one = incoming_.begin(); one != incoming_.end(); ++one) {
    const auto same_sender = [&](const Transfer& other) { return other.message.from == one->message.from; };
    if (one->done && std::find_if(incoming_.begin(), one, same_sender) == one) return one;
  }
  return incoming_.end();
}

std::optional<Message> MpiRank::poll() {
  const std::lock_guard lock(mutex_);
  progress();
  accept_messages();
  const auto one = next();
  if (one == incoming_.end()) return std::nullopt;
  Message message = std::move(one->message);
  received_ = Clock::now();
  incoming_.erase(one);
  return message;
}

/// OpenMPI's own waiting calls spin and take a core each, which ranks that share one with their runs cannot afford. So:
/// look, and sleep for longer and longer between looks. But where messages come one close behind the other, whoever
/// slept would hold the others up by more than they compute: there only the core is offered to others.
bool MpiRank::wait(std::chrono::milliseconds limit) {
  constexpr std::chrono::microseconds kShortest{20}, kLongest{2000}, kClose{500};
  const Clock::time_point end = Clock::now() + limit;
  std::chrono::microseconds pause = kShortest;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      progress();
      accept_messages();
      if (next() != incoming_.end()) return true;
    }
    const Clock::time_point now = Clock::now();
    if (now >= end) return false;
    if (now - received_ < kClose) {
      std::this_thread::yield();
      continue;
    }
    std::this_thread::sleep_for(std::min<Clock::duration>(pause, end - now));
    pause = std::min(2 * pause, kLongest);
  }
}

void MpiRank::abort(const std::string& reason) {
  std::cout << std::flush;
  std::cerr << "torolux: rank " << ranks_.own << " (" << host_name() << "): " << reason << std::endl;
  constexpr int kFailure = static_cast<int>(ExitCode::machine_failure);
  tell_starter(kFailure);
  MPI_Abort(MPI_COMM_WORLD, kFailure);
  std::_Exit(kFailure);
}

void MpiRank::close(std::span<const unsigned> lost, int exit_code) {
  if (!lost.empty()) {
    // MPI_Finalize would wait for them. The first that lives ends all; the others give it time for that.
    std::cout << std::flush;
    std::cerr << std::flush;
    unsigned first = 0;
    while (std::ranges::find(lost, first) != lost.end()) ++first;
    if (first != ranks_.own) std::this_thread::sleep_for(std::chrono::seconds(10));
    tell_starter(exit_code);
    const std::lock_guard lock(mutex_);
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }
  // Nobody leaves before all have handed theirs over: what is large is taken only as long as its receiver is there.
  MPI_Request all = MPI_REQUEST_NULL;
  bool has_said = false;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      progress();
      accept_messages();
      if (outgoing_.empty() && !has_said) {
        MPI_Ibarrier(MPI_COMM_WORLD, &all);
        has_said = true;
      }
      int done = 0;
      if (has_said && (MPI_Test(&all, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS || done != 0)) break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const std::lock_guard lock(mutex_);
  MPI_Finalize();
}

}  // namespace

std::vector<std::string> mpi_launcher() {
  const std::string program = TOROLUX_MPIRUN;  // as found when this was built
  // It may have been built on another computer.
  std::vector<std::string> words = {
      ::access(program.c_str(), X_OK) == 0 ? program : program.substr(program.find_last_of('/') + 1)};
#ifdef OPEN_MPI
  // A rank more than cores is right, and each has its threads. Quiet: what went wrong, the ranks tell.
  words.insert(words.end(), {"--quiet", "--oversubscribe", "--bind-to", "none"});
  if (::geteuid() == 0) words.emplace_back("--allow-run-as-root");
#endif
  return words;
}

std::unique_ptr<Transport> join_mpi() {
  auto transport = std::make_unique<MpiRank>();
  const Ranks told = launched_ranks();
  if (transport->ranks().count == told.count) return transport;
  transport->close({}, 0);
  throw UsageError("mpirun has started " + std::to_string(told.count) + " ranks, and the MPI of this build knows of " +
                   std::to_string(transport->ranks().count) +
                   ": take the mpirun of the MPI that it was built with (mpirun.openmpi, mpirun.mpich)");
}

}  // namespace torolux::ranks
