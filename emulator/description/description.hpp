// SPDX-License-Identifier: MIT
// The machine's parameters: a TOML file (`--machine`) enters and overrides built-in defaults key by key; a whole
// description leaves.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "emulator/description/host_work.hpp"

namespace torolux {

/// Classes of instructions that cost the same; the latency table gives each its cycles.
enum class InstructionClass : std::uint8_t {
  integer,  ///< add, shift, logic, compare, lui, auipc, fence, csr
  branch,   ///< conditional, whether taken or not
  jump,     ///< jal, jalr
  load,     ///< integer and floating point
  store,
  multiply,        ///< mul, mulh*
  divide,          ///< div*, rem*
  atomic,          ///< lr, sc, amo*
  float_simple,    ///< sign injection, min, max, compare, classify, moves
  float_add,       ///< fadd, fsub, conversions
  float_multiply,  ///< fmul
  float_fused,     ///< fmadd and kin
  float_divide,
  float_sqrt,
  hint,  ///< the NIU's instruction: issue only, waiting comes on top. Phase markers cost nothing.
  count
};
inline constexpr std::size_t kInstructionClasses = static_cast<std::size_t>(InstructionClass::count);
using LatencyTable = std::array<std::uint32_t, kInstructionClasses>;  ///< [cycles], each >= 1

struct MachineDescription {
  struct Processor {
    double clock_hertz = 100e6;
    LatencyTable latency = {1, 2, 2, 2, 1, 3, 20, 4, 1, 4, 4, 5, 16, 20, 2};
    std::uint64_t most_cycles_between_hints = 2'000'000'000;  ///< more is an endless loop

    bool operator==(const Processor&) const = default;
  } processor;

  struct Torus {
    std::uint32_t flit_bytes = 16;
    std::uint32_t router_cycles = 3;        ///< head of a packet through a router
    std::uint32_t link_cycles = 1;          ///< and over a link, >= 1
    std::uint32_t buffer_packets = 4;       ///< slots of the largest packet in each input buffer, >= 2
    std::uint32_t slot_return_cycles = 1;   ///< until the router upstream knows of a freed slot, >= 1
    std::uint32_t send_queue_packets = 32;  ///< outgoing queue of a NIU, >= 1
    bool bubble = true;                     ///< off only to see the deadlock that it prevents
    std::uint32_t patience_cycles = 64;     ///< that a packet waits to enter a ring before its router says so
    double link_error_rate = 0;             ///< chance that a packet's CRC fails on a link, 0..0.5
    std::uint32_t retry_cycles = 8;         ///< from the tail of a packet with a bad CRC to the start of the next try

    bool operator==(const Torus&) const = default;
  } torus;

  struct Bus {
    std::uint32_t bytes_per_cycle = 8;
    std::uint32_t arbitration_cycles = 4;    ///< >= 1
    std::uint32_t send_queue_messages = 16;  ///< outgoing queue of a NIU, >= 1
    std::uint32_t control_buffers = 2;       ///< messages that wait in a NIU for the processor, >= 1
    std::uint32_t signal_cycles = 4;         ///< of a request, a grant or a freed place, seen at the other end; >= 1

    bool operator==(const Bus&) const = default;
  } bus;

  struct Niu {
    std::uint32_t bytes_per_cycle = 8;  ///< of each of its two copy engines
    std::uint32_t receive_packets = 2;  ///< from the torus, that wait to be copied into record slots, >= 1

    bool operator==(const Niu&) const = default;
  } niu;

  struct FrameBuffer {
    std::uint32_t cycles_per_pixel = 6;  ///< one addition: three sums of 8 bytes read and written
    std::uint32_t queue_messages = 16;

    bool operator==(const FrameBuffer&) const = default;
  } frame_buffer;

  struct Host {
    double clock_hertz = 3e9;       ///< of its one processor
    std::uint32_t cost_factor = 1;  ///< of all its costs; 0: it takes no time
    /// By HostWork: its own cycles for an item. docs/costs.md says where they come from.
    std::array<std::uint32_t, kHostWorks> cycles = {1500, 15, 30, 15, 600, 60, 100, 15, 300, 2000, 2100, 9000};

    bool operator==(const Host&) const = default;
  } host;

  /// Parts that cost nothing, to show what they cost otherwise.
  struct Ideal {
    bool host = false;     ///< all that the host computes and all its messages
    bool niu = false;      ///< copies between local memory and the NIU; as many receive buffers as it takes
    bool signals = false;  ///< who may send is known everywhere at once

    bool operator==(const Ideal&) const = default;
  } ideal;

  struct Records {
    std::uint32_t credits_per_pe = 1024;  ///< W = this * PEs, >= 1
    std::uint32_t niu_slots = 2048;       ///< record slots of a NIU, >= kMostRecordsPerPacket
    std::uint32_t gather_cycles = 16384;  ///< NiuWindow::gather of the PE firmware
    std::uint32_t gather_records = 2048;  ///< likewise

    bool operator==(const Records&) const = default;
  } records;

  struct Jitter {
    std::uint32_t seed = 0;  ///< 0: none
    std::uint32_t cycles =
        64;  ///< longest delay of a link, router or bus transfer, by a hash: shakes the order of events

    bool operator==(const Jitter&) const = default;
  } jitter;

  bool operator==(const MachineDescription&) const = default;

  /// Of each of a NIU's copy engines, in a cycle; 0: copies take no time.
  std::uint32_t copy_bytes() const { return ideal.niu ? 0 : niu.bytes_per_cycle; }
  std::uint32_t signal_cycles() const { return ideal.signals ? 0 : bus.signal_cycles; }
};

/// Reads a machine file. Unknown keys, wrong types and values out of range throw InputError with file and line.
MachineDescription load_machine_description(const std::filesystem::path& file);

/// The same from text; source_name stands for the file in messages.
MachineDescription parse_machine_description(std::string_view text, std::string_view source_name);

/// Every key of a machine file, with its table ("torus.flit_bytes"), in the order of machine.toml.
std::vector<std::string> machine_description_keys();

using MachineValue = std::variant<std::uint64_t, double, bool>;
struct MachineSetting {
  std::string key;  ///< with its table
  MachineValue value;
};

/// Every key with its value, in the same order.
std::vector<MachineSetting> machine_description_values(const MachineDescription& description);

/// As it may stand in a machine file; a number reads back as the same bits.
std::string text_of(const MachineValue& value);

/// assignment: one key and its value, as in a machine file: "torus.flit_bytes=16". Throws UsageError where it has not
/// that form, InputError for an unknown key or a value that is not allowed.
void set_machine_value(MachineDescription& description, const std::string& assignment);

/// Name of a class in the machine file's table [processor.latency].
std::string_view name_of(InstructionClass instruction_class);

}  // namespace torolux
