#pragma once

#include <deque>
#include <functional>
#include <limits>
#include <mutex>
#include <new>
#include <thread>
#include <vector>

#include "engine/run/ranks/team.h"

namespace poesy::test {

/// A network for ranks that are threads of this process. Each rank has a queue of messages.
class FakeNetwork {
 public:
  /// room: the largest message (bytes) that ranks other than rank 0 can receive.
  FakeNetwork(std::size_t size, std::size_t room) : room_(room), inboxes_(size) {}

  void send(std::size_t to, Ranks::Message message) {
    const std::lock_guard lock(mutex_);
    bytes_ += message.bytes.size();
    inboxes_[to].push_back(std::move(message));
  }

  std::optional<Ranks::Message> receive(std::size_t at) {
    const std::lock_guard lock(mutex_);
    if (inboxes_[at].empty()) return std::nullopt;
    Ranks::Message message = std::move(inboxes_[at].front());
    inboxes_[at].pop_front();
    if (at > 0 && message.bytes.size() > room_) throw std::bad_alloc();
    return message;
  }

  std::size_t size() const { return inboxes_.size(); }
  /// Number of bytes of all sent messages.
  std::size_t bytes() const { return bytes_; }
  /// Number of messages that were not received.
  std::size_t left() const {
    std::size_t sum = 0;
    for (const auto& inbox : inboxes_) sum += inbox.size();
    return sum;
  }

 private:
  std::mutex mutex_;
  std::size_t room_;
  std::vector<std::deque<Ranks::Message>> inboxes_;
  std::size_t bytes_ = 0;
};

class FakeRanks : public Ranks {
 public:
  FakeRanks(FakeNetwork& network, std::size_t rank) : network_(&network), rank_(rank) {}

  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return network_->size(); }
  std::string name() const override { return "rank " + std::to_string(rank_) + " on fake"; }
  void send(std::size_t to, std::shared_ptr<const Bytes> bytes) override { network_->send(to, {rank_, *bytes}); }
  std::optional<Message> try_receive() override { return network_->receive(rank_); }

 private:
  FakeNetwork* network_;
  std::size_t rank_;
};

/// How a run on fake ranks ended.
struct FakeRun {
  std::vector<int> exit_codes;      ///< exit code of each rank
  std::optional<RankLeft> left;     ///< the rank that left first and why, as rank 0 knows it
  std::exception_ptr problem;       ///< the exception that rank 0's body threw
  std::size_t bytes = 0;            ///< number of bytes of all messages
  std::size_t messages_unread = 0;  ///< after all ranks have ended
};

/// Runs the body on each rank as the program does. The exit code of rank 0 is 0, 9 if its body threw, or 7 if the other
/// ranks did not end in time.
inline FakeRun run_on_fake_ranks(std::size_t size, const std::function<void(Team&)>& body,
                                 std::size_t room = std::numeric_limits<std::size_t>::max()) {
  FakeNetwork network(size, room);
  FakeRun run;
  run.exit_codes.resize(size);
  std::vector<std::thread> others;
  for (std::size_t rank = 1; rank < size; ++rank) {
    others.emplace_back([&, rank] {
      FakeRanks ranks(network, rank);
      Team team(ranks);
      run.exit_codes[rank] = team.follow([&] { body(team); });
    });
  }
  FakeRanks ranks(network, 0);
  Team team(ranks);
  try {
    body(team);
  } catch (...) {
    run.problem = std::current_exception();
  }
  run.exit_codes[0] = run.problem ? 9 : 0;
  if (!team.dismiss(run.exit_codes[0], std::chrono::seconds(60))) run.exit_codes[0] = 7;
  for (std::thread& other : others) other.join();
  run.left = team.left();
  run.bytes = network.bytes();
  run.messages_unread = network.left();
  return run;
}

}  // namespace poesy::test
