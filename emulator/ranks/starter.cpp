// SPDX-License-Identifier: MIT
// Launchers end all ranks as soon as one is gone, so the starter has to hear of it first. Therefore the keeper: as long
// as it is there, all that the launcher has given to the rank is open, and its child has not ended. And where the
// keeper itself is killed, its connection, which it shares with nobody, closes before the launcher is told of its end.
#include "emulator/ranks/starter.hpp"

#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <optional>

#include "emulator/ranks/abstract_address.hpp"
#include "emulator/ranks/launched.hpp"

namespace torolux::ranks {
namespace {

/// For the life of a process. Not open: nobody has started this rank so, or not on this computer.
class StarterSocket {
 public:
  StarterSocket() {
    const char* const name = std::getenv(kStarterVariable);
    if (name == nullptr || launched_ranks().count == 1) return;
    const auto address = abstract_address(name);
    if (!address) return;
    socket_ = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (::connect(socket_, address->any(), address->bytes) != 0) close();
  }
  StarterSocket(const StarterSocket&) = delete;
  StarterSocket& operator=(const StarterSocket&) = delete;
  ~StarterSocket() { close(); }

  bool open() const { return socket_ >= 0; }
  void say(StarterWord::Kind kind, int status) const {
    const StarterWord word{kind, launched_ranks().own, status};
    if (open()) ::send(socket_, &word, sizeof(word), MSG_NOSIGNAL);
  }

 private:
  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

  int socket_ = -1;
};

/// The rank's own, from join_starter on.
std::optional<StarterSocket>& own_socket() {
  static std::optional<StarterSocket> socket;
  return socket;
}

sigset_t kept_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int number : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&signals, number);
  return signals;
}

/// Passes signals on until the child has ended, and ends.
[[noreturn]] void keep(pid_t child, const StarterSocket& socket) {
  ::prctl(PR_SET_NAME, "torolux-keeper");  // for ps
  const sigset_t signals = kept_signals();
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {  // -1: there is none, whatever became of it
    int number = 0;
    ::sigwait(&signals, &number);
    if (number != SIGCHLD) ::kill(child, number);
  }
  socket.say(StarterWord::Kind::died, status);
  ::_exit(WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status));
}

}  // namespace

bool join_starter() {
  const StarterSocket of_keeper;
  if (!of_keeper.open()) return false;
  of_keeper.say(StarterWord::Kind::keeps, 0);
  const sigset_t signals = kept_signals();
  sigset_t before;
  ::sigprocmask(SIG_BLOCK, &signals, &before);
  ::signal(SIGCHLD, SIG_DFL);  // ignored by a parent, it would not come, nor a status be kept
  const pid_t keeper = ::getpid();
  const pid_t child = ::fork();
  if (child > 0) keep(child, of_keeper);
  if (child == 0) ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (child == 0 && ::getppid() != keeper) ::_exit(1);  // it died before that
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  own_socket().emplace().say(StarterWord::Kind::begins, 0);
  return has_starter();
}

bool has_starter() {
  return own_socket() && own_socket()->open();
}

void tell_starter(int exit_code) {
  if (has_starter()) own_socket()->say(StarterWord::Kind::ends, exit_code);
}

}  // namespace torolux::ranks
