#include "engine/app/mpi_ranks.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/error.h"

#ifdef POESY_WITH_MPI
#include <mpi.h>
#endif

namespace poesy::app {
namespace {

std::optional<std::size_t> number_in(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr) return std::nullopt;
  const std::string_view text = value;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

std::optional<Launch> find_launch() {
  struct Variables {
    const char* rank;
    const char* size;
  };
  for (const auto& [rank_in, size_in] : {Variables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                         {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"},
                                         {"PMI_RANK", "PMI_SIZE"}}) {
    const auto rank = number_in(rank_in);
    const auto size = number_in(size_in);
    if (rank && size && *rank < *size) return Launch{*rank, *size};
  }
  return std::nullopt;
}

bool is_first_process() { return find_launch().value_or(Launch()).rank == 0; }

#ifdef POESY_WITH_MPI

namespace {

/// A long message is sent in pieces of this size. If a rank has no memory for the whole message, it can still receive
/// the pieces and drop them; otherwise the sender would wait forever. The tag of a piece is the number of pieces that
/// follow it, but at most kMostTag, because every MPI supports tags up to this number.
constexpr std::size_t kPieceBytes = std::size_t{4} << 20U;
constexpr std::size_t kMostTag = 32767;

std::string processor_name() {
  std::string name(MPI_MAX_PROCESSOR_NAME, '\0');
  int length = 0;
  MPI_Get_processor_name(name.data(), &length);
  name.resize(static_cast<std::size_t>(length));
  return name;
}

std::size_t count_on_this_machine() {
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  int size = 1;
  MPI_Comm_size(here, &size);
  MPI_Comm_free(&here);
  return static_cast<std::size_t>(size);
}

/// Ranks that are connected by MPI. If an MPI call fails, MPI ends the program, which is its default behaviour.
class MpiRanks : public LaunchedRanks {
 public:
  MpiRanks() {
    // Only one thread at a time makes MPI calls: the one that gives work to the other ranks (on rank 0) or takes work
    // from rank 0.
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    int number = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &number);
    rank_ = static_cast<std::size_t>(number);
    MPI_Comm_size(MPI_COMM_WORLD, &number);
    size_ = static_cast<std::size_t>(number);
    partial_.resize(size_);
    threads_allowed_ = provided >= MPI_THREAD_FUNNELED;
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;
  ~MpiRanks() override {
    for (Sending& sending : under_way_) MPI_Wait(&sending.request, MPI_STATUS_IGNORE);
    MPI_Finalize();
  }

  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return size_; }
  std::size_t on_this_machine() const override { return count_on_this_machine(); }
  std::string name() const override { return "rank " + std::to_string(rank_) + " on " + processor_name(); }
  bool threads_allowed() const { return threads_allowed_; }

  void send(std::size_t to, std::shared_ptr<const Bytes> bytes) override {
    under_way_.reserve(under_way_.size() + bytes->size() / kPieceBytes +
                       1);  // memory for all pieces is reserved first, so either all pieces are sent or none
    std::size_t sent = 0;
    do {
      const std::size_t count = std::min(kPieceBytes, bytes->size() - sent);
      const std::size_t following = (bytes->size() - sent - count + kPieceBytes - 1) / kPieceBytes;
      const auto tag = static_cast<int>(std::min(kMostTag, following));
      Sending& sending = under_way_.emplace_back(Sending{MPI_REQUEST_NULL, bytes});
      MPI_Isend(bytes->data() + sent, static_cast<int>(count), MPI_BYTE, static_cast<int>(to), tag, MPI_COMM_WORLD,
                &sending.request);
      sent += count;
    } while (sent < bytes->size());
  }

  std::optional<Message> try_receive() override {
    forget_what_was_sent();
    for (;;) {
      int found = 0;
      MPI_Message message = MPI_MESSAGE_NULL;
      MPI_Status status;
      MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &found, &message, &status);
      if (found == 0) return std::nullopt;
      int count = 0;
      MPI_Get_count(&status, MPI_BYTE, &count);
      const auto from = static_cast<std::size_t>(status.MPI_SOURCE);
      Receiving& receiving = partial_[from];
      std::byte* const room =
          room_in(receiving, static_cast<std::size_t>(count), static_cast<std::size_t>(status.MPI_TAG));
      MPI_Mrecv(room, count, MPI_BYTE, &message, &status);
      if (status.MPI_TAG > 0) continue;
      Receiving received = std::exchange(receiving, {});
      if (received.lost) throw std::bad_alloc();
      return Message{from, std::move(received.bytes)};
    }
  }

  [[noreturn]] void abort(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::abort();
  }

 private:
  struct Sending {
    MPI_Request request;
    std::shared_ptr<const Bytes> bytes;
  };

  struct Receiving {
    Bytes bytes;
    bool lost = false;  ///< true if there was not enough memory for the message
  };

  /// The memory for the next piece of a message. If there is no memory for the message, its pieces go into a buffer
  /// that is never read. count: bytes of the piece. following: number of pieces after it.
  std::byte* room_in(Receiving& receiving, std::size_t count, std::size_t following) {
    const std::size_t before = receiving.bytes.size();
    try {
      if (!receiving.lost) {
        receiving.bytes.reserve(before + count + following * kPieceBytes);
        receiving.bytes.resize(before + count);
        return receiving.bytes.data() + before;
      }
    } catch (const std::bad_alloc&) {
      receiving = {{}, true};
    }
    return nowhere_.get();
  }

  void forget_what_was_sent() {
    std::erase_if(under_way_, [](Sending& sending) {
      int done = 0;
      MPI_Test(&sending.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
  }

  std::size_t rank_ = 0;
  std::size_t size_ = 1;
  bool threads_allowed_ = false;
  std::vector<Sending> under_way_;
  std::vector<Receiving> partial_;  ///< for each rank, the message from it that is not yet complete
  std::unique_ptr<std::byte[]> nowhere_ = std::make_unique_for_overwrite<std::byte[]>(kPieceBytes);
};

}  // namespace

std::unique_ptr<LaunchedRanks> connect_ranks(const Launch& launch) {
  auto ranks = std::make_unique<MpiRanks>();
  if (ranks->size() != launch.size) {
    throw InputError({},
                     "the launcher started " + std::to_string(launch.size) + " processes, but MPI connects " +
                         std::to_string(ranks->size()),
                     "use the launcher of the Open MPI that poesy was built with: mpirun, or srun --mpi=pmix");
  }
  if (!ranks->threads_allowed()) {
    throw InputError({}, "this MPI does not allow threads", "use one that gives MPI_THREAD_FUNNELED");
  }
  return ranks;
}

#else

std::unique_ptr<LaunchedRanks> connect_ranks(const Launch& launch) {
  throw InputError({}, "a launcher started " + std::to_string(launch.size) + " processes, but this poesy has no MPI",
                   "build it with -DPOESY_MPI=ON, for which Debian has libopenmpi-dev; or start one process");
}

#endif

}  // namespace poesy::app
