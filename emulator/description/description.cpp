// SPDX-License-Identifier: MIT
// A machine file (TOML) in, a description out. One table of keys says what there is and what is allowed.
#include "emulator/description/description.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <variant>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "emulator/toml.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {
namespace {

using Description = MachineDescription;
using Place = std::variant<std::uint32_t*, std::uint64_t*, double*, bool*>;

/// One key of the file, the place of its value, and the values allowed.
struct Key {
  std::string name;  // with its table: "torus.flit_bytes"
  Place place;
  double least = 0;
  double most = 0;
};

constexpr double kMostCycles = 1'000'000;
constexpr double kMostLatency = 1000;

void add_processor_keys(Description& d, std::vector<Key>& keys) {
  keys.push_back({"processor.clock_hertz", &d.processor.clock_hertz, 1, 1e12});
  keys.push_back({"processor.most_cycles_between_hints", &d.processor.most_cycles_between_hints, 1000, 1e15});
  for (std::size_t i = 0; i < kInstructionClasses; ++i) {
    keys.push_back({"processor.latency." + std::string(name_of(static_cast<InstructionClass>(i))),
                    &d.processor.latency[i], 1, kMostLatency});
  }
}

void add_network_keys(Description& d, std::vector<Key>& keys) {
  keys.push_back({"torus.flit_bytes", &d.torus.flit_bytes, 1, protocol::kMostPacketBytes});
  keys.push_back({"torus.router_cycles", &d.torus.router_cycles, 1, kMostCycles});
  keys.push_back({"torus.link_cycles", &d.torus.link_cycles, 1, kMostCycles});
  keys.push_back({"torus.buffer_packets", &d.torus.buffer_packets, 2, 4096});
  keys.push_back({"torus.slot_return_cycles", &d.torus.slot_return_cycles, 1, kMostCycles});
  keys.push_back({"torus.send_queue_packets", &d.torus.send_queue_packets, 1, 256});
  keys.push_back({"torus.bubble", &d.torus.bubble});
  keys.push_back({"torus.patience_cycles", &d.torus.patience_cycles, 1, 1'000'000'000});
  keys.push_back({"torus.link_error_rate", &d.torus.link_error_rate, 0, 0.5});
  keys.push_back({"torus.retry_cycles", &d.torus.retry_cycles, 1, kMostCycles});
}

void add_other_keys(Description& d, std::vector<Key>& keys) {
  keys.push_back({"bus.bytes_per_cycle", &d.bus.bytes_per_cycle, 1, 4096});
  keys.push_back({"bus.arbitration_cycles", &d.bus.arbitration_cycles, 1, kMostCycles});
  keys.push_back({"bus.send_queue_messages", &d.bus.send_queue_messages, 1, 256});
  keys.push_back({"bus.control_buffers", &d.bus.control_buffers, 1, 4096});
  keys.push_back({"bus.signal_cycles", &d.bus.signal_cycles, 1, kMostCycles});
  keys.push_back({"niu.bytes_per_cycle", &d.niu.bytes_per_cycle, 1, 4096});
  keys.push_back({"niu.receive_packets", &d.niu.receive_packets, 1, 4096});
  keys.push_back({"frame_buffer.cycles_per_pixel", &d.frame_buffer.cycles_per_pixel, 1, kMostCycles});
  keys.push_back({"frame_buffer.queue_messages", &d.frame_buffer.queue_messages, 1, 65536});
  keys.push_back({"host.clock_hertz", &d.host.clock_hertz, 1, 1e12});
  keys.push_back({"host.cost_factor", &d.host.cost_factor, 0, 1000});
  for (std::size_t i = 0; i < kHostWorks; ++i) {
    keys.push_back({"host.cycles." + std::string(kHostWorkNames[i]), &d.host.cycles[i], 0, kMostCycles});
  }
  keys.push_back({"records.credits_per_pe", &d.records.credits_per_pe, 1, 65536});
  keys.push_back({"records.niu_slots", &d.records.niu_slots, protocol::kMostRecordsPerPacket, 4096});
  keys.push_back({"records.gather_cycles", &d.records.gather_cycles, 0, 1'000'000'000});
  keys.push_back({"records.gather_records", &d.records.gather_records, 1, 4096});
  keys.push_back({"jitter.seed", &d.jitter.seed, 0, 4294967295.0});
  keys.push_back({"jitter.cycles", &d.jitter.cycles, 0, kMostCycles});
}

void add_ideal_keys(Description& d, std::vector<Key>& keys) {
  keys.push_back({"ideal.host", &d.ideal.host});
  keys.push_back({"ideal.niu", &d.ideal.niu});
  keys.push_back({"ideal.signals", &d.ideal.signals});
}

std::vector<Key> keys_of(Description& description) {
  std::vector<Key> keys;
  add_processor_keys(description, keys);
  add_network_keys(description, keys);
  add_other_keys(description, keys);
  add_ideal_keys(description, keys);
  return keys;
}

std::string plain(double value) {
  std::ostringstream text;
  text.precision(15);
  text << value;
  return text.str();
}

[[noreturn]] void fail(std::string_view file, const toml::source_position& at, const std::string& what) {
  throw InputError(file.empty() ? what : std::string(file) + ":" + std::to_string(at.line) + ": " + what);
}

class Reader {
 public:
  Reader(std::string_view file, std::vector<Key> keys) : file_(file), keys_(std::move(keys)) {}

  void read_table(const toml::table& table, const std::string& prefix) const {
    for (auto&& [name, node] : table) {
      const std::string key_name = prefix + std::string(name.str());
      if (const toml::table* inner = node.as_table()) {
        if (!is_table_name(key_name)) {
          unknown(key_name, name.source().begin);
        }
        read_table(*inner, key_name + ".");
        continue;
      }
      const auto key = std::find_if(keys_.begin(), keys_.end(), [&](const Key& k) { return k.name == key_name; });
      if (key == keys_.end()) {
        unknown(key_name, name.source().begin);
      }
      std::visit([&, &value = node](auto* place) { read_value(*key, value, *place); }, key->place);
    }
  }

 private:
  bool is_table_name(const std::string& name) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const Key& key) { return key.name.starts_with(name + "."); });
  }

  [[noreturn]] void unknown(const std::string& name, const toml::source_position& at) const {
    // Of the table that it stands in; where there is none, all.
    const std::string table = name.substr(0, name.rfind('.') + 1);
    const bool is_table = !table.empty() && is_table_name(table.substr(0, table.size() - 1));
    std::string known;
    for (const Key& key : keys_) {
      if (!is_table || key.name.starts_with(table)) known += (known.empty() ? "" : ", ") + key.name;
    }
    std::vector<std::string> names;
    for (const Key& key : keys_) {
      names.push_back(key.name);
      names.push_back(key.name.substr(0, key.name.find('.')));
    }
    const std::string near = did_you_mean(name, names);
    fail(file_, at,
         "unknown key '" + name + "'" + near + (near.empty() ? "; a" : " A") + " machine file may set " + known);
  }

  [[noreturn]] void refuse(const Key& key, const toml::node& node, const std::string& kind) const {
    fail(file_, node.source().begin,
         "'" + key.name + "' must be " + kind + " from " + plain(key.least) + " to " + plain(key.most));
  }

  template <class Integer>
  void read_value(const Key& key, const toml::node& node, Integer& place) const {
    const auto* value = node.as_integer();
    if (value == nullptr || static_cast<double>(value->get()) < key.least ||
        static_cast<double>(value->get()) > key.most) {
      refuse(key, node, "a whole number");
    }
    place = static_cast<Integer>(value->get());
  }

  void read_value(const Key& key, const toml::node& node, double& place) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= key.least && *value <= key.most)) {  // refuses NaN, too
      refuse(key, node, "a number");
    }
    place = *value;
  }

  void read_value(const Key& key, const toml::node& node, bool& place) const {
    const auto* value = node.as_boolean();
    if (value == nullptr) {
      fail(file_, node.source().begin, "'" + key.name + "' must be true or false");
    }
    place = value->get();
  }

  std::string_view file_;
  std::vector<Key> keys_;
};

/// An empty source_name is left out of messages.
void read_keys(MachineDescription& description, std::string_view text, std::string_view source_name) {
  toml::table table;
  try {
    table = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    fail(source_name, error.source().begin, std::string(error.description()));
  }
  Reader(source_name, keys_of(description)).read_table(table, "");
}

MachineValue value_at(std::uint32_t* place) {
  return std::uint64_t{*place};
}
MachineValue value_at(auto* place) {
  return *place;
}

}  // namespace

MachineDescription parse_machine_description(std::string_view text, std::string_view source_name) {
  MachineDescription description;
  read_keys(description, text, source_name);
  return description;
}

void set_machine_value(MachineDescription& description, const std::string& assignment) {
  constexpr const char* kKeyCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.";
  const std::size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  if (equals == std::string::npos || key.empty() || key.find_first_not_of(kKeyCharacters) != std::string::npos ||
      assignment.find_first_of("\n\r#") != std::string::npos)
    throw UsageError("\"" + assignment + "\" is not a key and a value like torus.flit_bytes=16");
  read_keys(description, assignment, "");
}

std::vector<MachineSetting> machine_description_values(const MachineDescription& description) {
  MachineDescription copy = description;
  std::vector<MachineSetting> settings;
  for (const Key& key : keys_of(copy))
    settings.push_back({key.name, std::visit([](auto* place) { return value_at(place); }, key.place)});
  return settings;
}

std::string text_of(const MachineValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* number = std::get_if<std::uint64_t>(&value)) return std::to_string(*number);
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), std::get<double>(value));
  return {text.data(), end.ptr};
}

MachineDescription load_machine_description(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = 1U << 20U;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    throw InputError(file.string() + ": the machine file cannot be read");
  }
  if (bytes > kMostBytes) {
    throw InputError(file.string() + ": no machine file is larger than 1 MiB");
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_machine_description(text.str(), file.string());
}

std::vector<std::string> machine_description_keys() {
  MachineDescription description;
  std::vector<std::string> names;
  for (const Key& key : keys_of(description)) {
    names.push_back(key.name);
  }
  return names;
}

std::string_view name_of(InstructionClass instruction_class) {
  constexpr std::array<std::string_view, kInstructionClasses> kNames = {
      "integer",      "branch",    "jump",           "load",        "store",        "multiply",   "divide", "atomic",
      "float_simple", "float_add", "float_multiply", "float_fused", "float_divide", "float_sqrt", "hint"};
  const auto index = static_cast<std::size_t>(instruction_class);
  return index < kNames.size() ? kNames[index] : "unknown";
}

}  // namespace torolux
