#include "engine/run/ranks/team.h"

#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "engine/base/error.h"

namespace poesy {
namespace {

constexpr auto kLastMessage = static_cast<std::uint64_t>(RankMessage::gone);
constexpr auto kLastReason = static_cast<std::uint64_t>(LeaveReason::internal);

}  // namespace

void LookPause::sleep() { std::this_thread::sleep_for(next()); }

ByteWriter Team::message(RankMessage about) {
  ByteWriter bytes;
  bytes.number(static_cast<std::uint64_t>(about));
  return bytes;
}

ByteReader Team::Received::reader() const {
  ByteReader content(bytes);
  content.number();
  return content;
}

void Team::send(std::size_t to, ByteWriter& bytes) { ranks_->send(to, std::make_shared<const Bytes>(bytes.take())); }

void Team::send_to_others(ByteWriter& bytes) {
  const auto shared = std::make_shared<const Bytes>(bytes.take());
  for (std::size_t rank = 1; rank < ranks_->size(); ++rank) ranks_->send(rank, shared);
}

std::optional<Team::Received> Team::try_receive() {
  while (auto message = ranks_->try_receive()) {
    ByteReader from(message->bytes);
    const auto about = static_cast<RankMessage>(from.number_up_to(kLastMessage));
    if (about == RankMessage::dismissed) throw Dismissed(static_cast<int>(from.number()));
    if (about == RankMessage::gone) {
      ++gone_;
    } else if (about == RankMessage::leaving) {
      const auto reason = static_cast<LeaveReason>(from.number_up_to(kLastReason));
      if (!left_) left_ = {reason, from.text()};
    } else {
      return Received{message->from, about, std::move(message->bytes)};
    }
  }
  return std::nullopt;
}

Team::Received Team::wait_for(RankMessage about) {
  for (LookPause pause;; pause.sleep()) {
    while (auto message = try_receive()) {
      if (message->about == about) return std::move(*message);
    }
  }
}

bool Team::agree(const std::string& study, std::size_t threads, const std::atomic<bool>* stop) {
  if (!leads()) {
    if (wait_for(RankMessage::study).reader().text() != study) return false;
    ByteWriter agreed = message(RankMessage::agreed);
    agreed.number(threads);
    send(0, agreed);
    return true;
  }
  ByteWriter own = message(RankMessage::study);
  own.text(study);
  send_to_others(own);
  threads_ = threads;
  std::size_t agreed = 1;
  for (LookPause pause; agreed < ranks_->size() && !left_; pause.sleep()) {
    while (const auto message = try_receive()) {
      threads_ += static_cast<std::size_t>(message->reader().number());
      ++agreed;
    }
    if (stop != nullptr && *stop && !left_) left_ = {LeaveReason::stopped, "stopped before all ranks had begun"};
  }
  return !left_;
}

Bytes Team::begin(const Bytes& state) {
  ++stage_;
  if (!leads()) {
    const Received begun = wait_for(RankMessage::begin);
    ByteReader from = begun.reader();
    if (from.number() != stage_) throw std::runtime_error("the ranks are not in the same part of the run");
    const std::span<const std::byte> begins_with = from.block();
    return {begins_with.begin(), begins_with.end()};
  }
  ByteWriter begun = message(RankMessage::begin);
  begun.number(stage_);
  begun.block(state);
  send_to_others(begun);
  return state;
}

void Team::end(bool complete, const Bytes& state) {
  ByteWriter ended = message(RankMessage::end);
  ended.number(complete ? 1 : 0);
  ended.block(complete ? std::span<const std::byte>(state) : std::span<const std::byte>());
  send_to_others(ended);
}

bool Team::take_end(ByteReader& message) {
  const bool complete = message.number() == 1;
  const std::span<const std::byte> state = message.block();
  end_state_.assign(state.begin(), state.end());
  return complete;
}

void Team::leave(LeaveReason reason, const std::string& problem) {
  ByteWriter leaving = message(RankMessage::leaving);
  leaving.number(static_cast<std::uint64_t>(reason));
  leaving.text(ranks_->name() + ": " + problem);
  send(0, leaving);
}

void Team::pass_over_messages() {
  try {
    while (try_receive()) {
    }
  } catch (const std::bad_alloc&) {
    // A message that does not fit into memory is dropped. Only messages of a stage are so long, and the stage is over.
  }
}

int Team::await_dismissal() {
  try {
    for (LookPause pause;; pause.sleep()) pass_over_messages();
  } catch (const Dismissed& dismissed) {
    return dismissed.code;
  }
}

int Team::follow(const std::function<void()>& body) {
  std::optional<int> code;
  const auto leave_for = [&](LeaveReason reason, const std::exception& error) { leave(reason, error.what()); };
  try {
    body();
  } catch (const Dismissed& dismissed) {
    code = dismissed.code;
  } catch (const InputError& error) {
    leave_for(LeaveReason::bad_input, error);
  } catch (const FileError& error) {
    leave_for(LeaveReason::file_trouble, error);
  } catch (const std::bad_alloc&) {
    leave(LeaveReason::file_trouble, kTooLittleMemory);
  } catch (const std::exception& error) {
    leave_for(LeaveReason::internal, error);
  }
  if (!code) code = await_dismissal();
  say_farewell();
  return *code;
}

void Team::say_farewell() {
  ByteWriter gone = message(RankMessage::gone);
  send(0, gone);
}

bool Team::dismiss(int exit_code, std::chrono::milliseconds patience) {
  ByteWriter over = message(RankMessage::dismissed);
  over.number(static_cast<std::uint64_t>(exit_code));
  send_to_others(over);
  const auto end = std::chrono::steady_clock::now() + patience;
  for (LookPause pause; gone_ + 1 < ranks_->size(); pause.sleep()) {
    pass_over_messages();
    if (std::chrono::steady_clock::now() > end) return false;
  }
  return true;
}

}  // namespace poesy
