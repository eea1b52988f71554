// SPDX-License-Identifier: MIT
// Proves of a study on several ranks, as threads with random delays: the same results and failures for any number of
// them, also more than runs; a rank that dies, falls silent or is told to end loses nothing but its run's time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>

#include "emulator/ranks/thread_ranks.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/study/farm_messages.hpp"
#include "host_tools/study/local_hands.hpp"
#include "host_tools/study/rank_hands.hpp"
#include "host_tools/study/runner.hpp"
#include "host_tools/study/serve.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::study {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;
using ranks::Transport;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::TemporaryFolder;

constexpr ranks::LifeTimes kTimes{10ms, 3000ms};
const std::string kProgram = "the same on all ranks";

/// What a shell does; `network`'s results are what it prints.
Work work(const std::string& name, const std::string& script, double expected = 0) {
  return {{{"-c", script}, name, "", expected}, name};
}

std::vector<Work> seven_runs() {
  std::vector<Work> all;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"})
    all.push_back(work(name, std::string("echo n; echo ") + std::to_string(name[0]), name[0] % 3));
  return all;
}

std::map<std::string, std::string> contents_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::vector<std::byte> bytes = read_file(entry.path(), 1U << 20U);
    files[entry.path().filename()].assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  return files;
}

/// What rank 0 of a study does.
RunnerEnd lead(Transport& transport, const std::vector<Work>& all, const std::filesystem::path& folder, unsigned jobs,
               ranks::LifeTimes times = kTimes) {
  const ResultFolder results(folder, "network");
  LocalHands own("/bin/sh", jobs, false);
  RankHands others(transport, 1, kProgram, times);
  RunnerEnd end = run_all(all, results, {"torolux", 1, {&own, &others}});
  others.end(0);
  return end;
}

void follow(Transport& transport) {
  LocalHands own("/bin/sh", 1, true);
  serve(transport, own, kProgram, kTimes);
}

struct Farmed {
  std::map<std::string, std::string> files;
  RunnerEnd end;
};

Farmed farm(unsigned ranks, std::uint64_t seed, const std::vector<Work>& all) {
  const TemporaryFolder folder;
  Farmed farmed;
  const auto ends = ranks::run_as_threads(ranks, {seed, 2000us}, [&](Transport& transport) {
    if (transport.ranks().own != 0) return follow(transport);
    farmed.end = lead(transport, all, folder.path(), 1);
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
  farmed.files = contents_of(folder.path());
  return farmed;
}

TEST(Farm, LeavesTheSameFilesForAnyNumberOfRanks) {
  const auto alone = farm(1, 0, seven_runs()).files;
  ASSERT_EQ(alone.size(), 7U);
  EXPECT_EQ(alone.at("b.csv"), "n\n98\n");
  for (const unsigned ranks : {2U, 3U, 5U, 9U}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const Farmed farmed = farm(ranks, seed, seven_runs());
      EXPECT_EQ(farmed.files, alone) << ranks << ", seed " << seed;
      EXPECT_EQ(farmed.end.started, 7U);
    }
  }
}

TEST(Farm, TellsFailuresAsOneRankDoes) {
  std::vector<Work> all = seven_runs();
  all.push_back(work("x", "echo why >&2; exit 3"));
  for (const unsigned ranks : {1U, 3U}) {
    const Farmed farmed = farm(ranks, 1, all);
    EXPECT_EQ(farmed.files.size(), 7U);
    ASSERT_EQ(farmed.end.failures.size(), 1U);
    const Failure& failure = farmed.end.failures[0];
    EXPECT_EQ(failure.exit_code, 3);
    EXPECT_EQ(failure.errors, "why\n");
    EXPECT_EQ(failure.command, "torolux -c 'echo why >&2; exit 3' --format csv");
  }
}

// Rank 0 has no hands of its own here, so that rank 1 is given the first run.
TEST(Farm, ARankThatDiesLosesOnlyItsRun) {
  const TemporaryFolder folder;
  std::atomic<bool> died = false;
  RunnerEnd end;
  testing::internal::CaptureStderr();
  ranks::run_as_threads(3, {1, 500us}, [&](Transport& transport) {
    if (transport.ranks().own == 0) {
      end = lead(transport, seven_runs(), folder.path(), 0);
    } else if (transport.ranks().own == 1) {
      transport.send(0, static_cast<std::uint32_t>(FarmMessage::greeting), bytes_of(Greeting{"a host", kProgram}));
      for (bool ordered = false; !ordered; transport.wait(1000ms)) {
        const auto message = transport.poll();
        ordered = message && message->kind == static_cast<std::uint32_t>(FarmMessage::order);
      }
      died = true;
    } else {
      while (!died) std::this_thread::sleep_for(1ms);
      follow(transport);
    }
  });
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("rank 1 (a host) has been silent for 3 s"));
  EXPECT_EQ(contents_of(folder.path()).size(), 7U);
  EXPECT_EQ(end.started, 7U);
  EXPECT_THAT(end.failures, IsEmpty());
}

// Its late answer is nobody's any more, and it is given runs again.
TEST(Farm, ARankThatIsHeardAgainWorksOn) {
  const TemporaryFolder folder;
  const ranks::LifeTimes hasty{1ms, 100ms};
  std::atomic<unsigned> answered = 0;
  RunnerEnd end;
  testing::internal::CaptureStderr();
  const auto answer = [&answered](Transport& transport, std::uint64_t number) {
    transport.send(0, static_cast<std::uint32_t>(FarmMessage::answer),
                   bytes_of(FarmAnswer{number, 0, "", "n\n" + std::to_string(++answered) + "\n"}));
  };
  ranks::run_as_threads(2, {}, [&](Transport& transport) {
    if (transport.ranks().own == 0) {
      end = lead(transport, {work("a", "")}, folder.path(), 0, hasty);
      return;
    }
    transport.send(0, static_cast<std::uint32_t>(FarmMessage::greeting), bytes_of(Greeting{"a host", kProgram}));
    for (;;) {
      transport.wait(1000ms);
      const auto message = transport.poll();
      if (!message || message->kind == ranks::kLifeSign) continue;
      if (message->kind == static_cast<std::uint32_t>(FarmMessage::close)) break;
      if (message->kind == static_cast<std::uint32_t>(FarmMessage::end)) {
        transport.send(0, static_cast<std::uint32_t>(FarmMessage::ready), {});
        continue;
      }
      if (answered == 0) std::this_thread::sleep_for(1000ms);
      answer(transport, content_of<FarmOrder>(message->bytes).order.number);
    }
    transport.close({}, 0);
  });
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("rank 1 (a host) has been silent"), HasSubstr("rank 1 (a host) is heard again")));
  EXPECT_EQ(contents_of(folder.path()).at("a.csv"), "n\n2\n");
  EXPECT_EQ(end.started, 1U);
}

TEST(Farm, ARankOfAnotherBuildEndsAll) {
  const TemporaryFolder folder;
  const auto ends = ranks::run_as_threads(2, {}, [&](Transport& transport) {
    if (transport.ranks().own == 0) {
      lead(transport, seven_runs(), folder.path(), 0);
    } else {
      LocalHands own("/bin/sh", 1, true);
      serve(transport, own, "another program", kTimes);
    }
  });
  EXPECT_THAT(ends, Each(AllOf(HasSubstr("rank 0: rank 1 ("), HasSubstr("runs another build of torolux"))));
}

TEST(Farm, WhereRank0IsSilentAllEnd) {
  const auto ends = ranks::run_as_threads(2, {}, [&](Transport& transport) {
    if (transport.ranks().own == 0) return;
    LocalHands own("/bin/sh", 1, true);
    serve(transport, own, kProgram, {1ms, 100ms});
  });
  EXPECT_THAT(ends[1], HasSubstr("rank 1: rank 0 is silent and counts as lost"));
}

// Nobody has given it anything: it is missed where all are to close.
TEST(Farm, ARankThatDiesAtTheEndIsNotWaitedFor) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  const auto ends = ranks::run_as_threads(3, {}, [&](Transport& transport) {
    if (transport.ranks().own == 0) lead(transport, seven_runs(), folder.path(), 1);
    if (transport.ranks().own == 2) follow(transport);
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("rank 1 has been silent for 3 s"));
  EXPECT_EQ(contents_of(folder.path()).size(), 7U);
}

TEST(Farm, MessagesThatAreNotWholeAreRefused) {
  const std::vector<std::byte> bytes = bytes_of(FarmAnswer{7, 3, "errors", std::string("re\0sult", 7)});
  const auto answer = content_of<FarmAnswer>(bytes);
  EXPECT_EQ(answer.number, 7U);
  EXPECT_EQ(answer.result, std::string("re\0sult", 7));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(content_of<FarmAnswer>(std::span(bytes).first(size)), InputError) << size;
  std::vector<std::byte> longer = bytes;
  longer.emplace_back();
  EXPECT_THROW(content_of<FarmAnswer>(longer), InputError);
}

// Bytes from another rank are bytes from outside.
TEST(Farm, OrdersThatCannotBeEndAll) {
  const auto ends_where_told = [](unsigned from, FarmMessage kind, const std::vector<std::byte>& bytes) {
    return ranks::run_as_threads(3, {}, [&](Transport& transport) {
      if (transport.ranks().own == 1) {
        LocalHands own("/bin/sh", 1, true);
        serve(transport, own, kProgram, kTimes);
      } else if (transport.ranks().own == from) {
        transport.send(1, static_cast<std::uint32_t>(kind), bytes);
      }
    })[1];
  };
  EXPECT_EQ(ends_where_told(2, FarmMessage::order, bytes_of(FarmOrder{"/", {0, {"-c", "true"}, true}})),
            "rank 1: rank 2 has sent a message; only rank 0 gives orders");
  EXPECT_EQ(ends_where_told(0, FarmMessage::close, bytes_of(FarmClose{{2, 3}, 0})),
            "rank 1: rank 0 counts rank 3 as lost; there are 3");
  EXPECT_EQ(ends_where_told(0, FarmMessage::ready, {}), "rank 1: rank 0 has sent a message of kind 6");
  EXPECT_EQ(ends_where_told(0, FarmMessage::close, {}), "rank 1: a message between ranks is too short");
}

// Statistics do not go into a file: kilobytes more than a pipe holds, and the output beside them.
TEST(Farm, ResultsComeThroughAStreamOfTheirOwn) {
  LocalHands hands("/bin/sh", 1, true);
  hands.start({5, {"-c", "echo printed; head -c 300000 /dev/zero > /dev/fd/3"}, false});
  std::optional<Answer> answer;
  while (!(answer = hands.poll())) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(answer->number, 5U);
  EXPECT_EQ(answer->outcome->result, std::string(300000, '\0'));
}

}  // namespace
}  // namespace torolux::study
