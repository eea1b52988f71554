// SPDX-License-Identifier: MIT
// Head, identity, the state as one zstd stream, and the SHA-256 of all that, which is looked at before anything else.
#include "host_tools/checkpoint/checkpoint_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

#include "host_tools/files/digest.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, written as it lies in memory");

struct Head {
  std::array<char, 6> magic;
  std::uint16_t version;
  std::uint64_t identity_bytes;  ///< that follow; behind them is the stream
};
static_assert(sizeof(Head) == 16);
constexpr std::array<char, 6> kMagic{'T', 'L', 'X', 'C', 'K', 'P'};
constexpr std::size_t kDigestBytes = 64;  ///< at the end: SHA-256 of all before, hexadecimal
constexpr std::size_t kMostIdentity = std::size_t{16} << 20U;
constexpr std::size_t kChunk = std::size_t{64} << 10U;
constexpr int kLevel = 1;  ///< a checkpoint is written often and read seldom

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::size_t checked(std::size_t result) {
  if (ZSTD_isError(result) != 0) throw InputError(std::string("zstd: ") + ZSTD_getErrorName(result));
  return result;
}

}  // namespace

// ---- Writing ----

struct CheckpointWriter::Parts {
  Parts(const std::filesystem::path& file, const std::string& identity)
      : out(file), context(ZSTD_createCCtx(), &ZSTD_freeCCtx), state([this](auto bytes) { compress(bytes); }) {
    checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel));
    const Head head{kMagic, kCheckpointVersion, identity.size()};
    put(std::as_bytes(std::span(&head, 1)));
    put(bytes_of(identity));
  }
  void put(std::span<const std::byte> bytes) {
    digest.add(bytes);
    out.append(bytes);
  }
  void compress(std::span<const std::byte> bytes, ZSTD_EndDirective end = ZSTD_e_continue) {
    ZSTD_inBuffer input{bytes.data(), bytes.size(), 0};
    for (std::size_t left = 1; end == ZSTD_e_end ? left != 0 : input.pos < input.size;) {
      ZSTD_outBuffer output{buffer.data(), buffer.size(), 0};
      left = checked(ZSTD_compressStream2(context.get(), &output, &input, end));
      put(std::span(buffer).first(output.pos));
    }
  }

  FileWriter out;
  Sha256 digest;
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context;
  std::vector<std::byte> buffer = std::vector<std::byte>(kChunk);
  SnapshotWriter state;
};

CheckpointWriter::CheckpointWriter(const std::filesystem::path& file, const std::string& identity)
    : parts_(std::make_unique<Parts>(file, identity)) {}
CheckpointWriter::~CheckpointWriter() = default;

SnapshotWriter& CheckpointWriter::state() {
  return parts_->state;
}

void CheckpointWriter::finish() {
  parts_->state.flush();
  parts_->compress({}, ZSTD_e_end);
  parts_->out.append(bytes_of(parts_->digest.hexadecimal()));
  parts_->out.finish();
}

// ---- Reading ----

struct CheckpointReader::Parts {
  explicit Parts(const std::filesystem::path& path)
      : name(path.string()),
        file(path, std::ios::binary),
        context(ZSTD_createDCtx(), &ZSTD_freeDCtx),
        state([this](auto bytes) { decompress(bytes); }) {
    std::error_code error;
    if (!file || !std::filesystem::is_regular_file(path, error)) throw InputError(name + ": cannot be read");
    const std::uint64_t all = std::filesystem::file_size(path, error);
    Head head{};
    read(std::as_writable_bytes(std::span(&head, 1)), all);
    if (head.magic != kMagic) throw InputError(name + ": is no checkpoint of torolux");
    if (head.version != kCheckpointVersion) {
      throw InputError(name + ": a checkpoint of version " + std::to_string(head.version) +
                       "; this program goes on from version " + std::to_string(kCheckpointVersion) + " alone");
    }
    check_digest(all);
    file.clear();
    file.seekg(sizeof head);
    left = all - kDigestBytes - sizeof head;
    if (head.identity_bytes > std::min<std::uint64_t>(kMostIdentity, left)) damaged();
    identity.resize(static_cast<std::size_t>(head.identity_bytes));
    read(std::as_writable_bytes(std::span(identity)), left);
    left -= identity.size();
  }
  [[noreturn]] void damaged() const { throw InputError(name + ": damaged or cut short; an older one may be whole"); }
  /// left: bytes of the file that there are.
  void read(std::span<std::byte> bytes, std::uint64_t there) {
    if (bytes.size() > there) damaged();
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (file.gcount() != static_cast<std::streamsize>(bytes.size())) damaged();
  }
  void check_digest(std::uint64_t all) {
    if (all < sizeof(Head) + kDigestBytes) damaged();
    file.seekg(0);
    Sha256 digest;
    for (std::uint64_t unread = all - kDigestBytes; unread != 0;) {
      const auto piece = std::span(buffer).first(static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, unread)));
      read(piece, unread);
      digest.add(piece);
      unread -= piece.size();
    }
    std::string there(kDigestBytes, ' ');
    read(std::as_writable_bytes(std::span(there)), kDigestBytes);
    if (there != digest.hexadecimal()) damaged();
  }
  void decompress(std::span<std::byte> bytes) {
    ZSTD_outBuffer output{bytes.data(), bytes.size(), 0};
    while (output.pos < output.size) {
      if (input.pos == input.size && left != 0) {
        const auto piece = std::span(buffer).first(static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, left)));
        read(piece, left);
        left -= piece.size();
        input = {buffer.data(), piece.size(), 0};
      }
      const std::size_t in_before = input.pos;
      const std::size_t out_before = output.pos;
      if (ZSTD_isError(ZSTD_decompressStream(context.get(), &output, &input)) != 0) damaged();
      if (input.pos == in_before && output.pos == out_before && left == 0) damaged();
    }
  }

  std::string name;
  std::ifstream file;
  std::vector<std::byte> buffer = std::vector<std::byte>(kChunk);
  std::uint64_t left = 0;  // of the stream, not yet in the buffer
  ZSTD_inBuffer input{nullptr, 0, 0};
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context;
  std::string identity;
  SnapshotReader state;
};

CheckpointReader::CheckpointReader(const std::filesystem::path& file) : parts_(std::make_unique<Parts>(file)) {}
CheckpointReader::~CheckpointReader() = default;

const std::string& CheckpointReader::identity() const {
  return parts_->identity;
}

SnapshotReader& CheckpointReader::state() {
  return parts_->state;
}

}  // namespace torolux
