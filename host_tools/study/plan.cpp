// SPDX-License-Identifier: MIT
// A plan's text (TOML) enters, the plan leaves, checked by names.
#include "host_tools/study/plan.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "emulator/description/description.hpp"
#include "emulator/nearest_name.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/toml_table.hpp"
#include "host_tools/study/options.hpp"

namespace torolux::study {
namespace {

constexpr std::size_t kMostPlanBytes = std::size_t{4} << 20U;

/// A node with its name, tables inside taken apart: [machine.torus] flit_bytes -> "machine.torus.flit_bytes".
struct Leaf {
  std::string name;
  const toml::node* node;
  Place place;
};

class PlanReader {
 public:
  PlanReader(const toml::table& root, const std::filesystem::path& file) : root_(root), file_(file.string()) {
    plan_.file = file;
  }

  Plan read() {
    TomlTable top(root_, file_, "the plan");
    const toml::table* base = top.table("base");
    if (base == nullptr) refuse({file_, 1}, "a plan has a table [base] with what every run has");
    read_command(*base);
    for (const Leaf& leaf : leaves(*base, {"command", "threads"})) plan_.base.push_back(option(leaf));
    for (const toml::table* run : top.tables("run")) {
      plan_.runs.emplace_back();
      for (const Leaf& leaf : leaves(*run, {})) plan_.runs.back().push_back(option(leaf));
    }
    if (const toml::table* vary = top.table("vary")) {
      plan_.vary_line = place_of(*vary, file_).line;
      for (const Leaf& leaf : leaves(*vary, {"zip"})) plan_.vary.push_back(axis(leaf));
      read_zip(*vary);
    }
    if (const toml::table* one = top.table("vary_one")) {
      for (const Leaf& leaf : leaves(*one, {})) plan_.vary_one.push_back(axis(leaf));
    }
    if (const toml::table* report = top.table("report")) read_report(TomlTable(*report, file_, "[report]"));
    top.finish();
    check_once();
    return std::move(plan_);
  }

 private:
  void read_command(const toml::table& table) {
    TomlTable base(table, file_, "[base]");
    plan_.command = base.required(base.text("command"), "command");
    plan_.threads = static_cast<unsigned>(base.integer("threads", 1, 4096).value_or(1));
    known_ = options_of(plan_.command, base.place("command"));
  }

  /// In the order of the file, which the library does not keep.
  std::vector<Leaf> leaves(const toml::table& table, const std::set<std::string_view>& skipped) const {
    std::vector<Leaf> found;
    for (auto&& [key, node] : table) {
      if (!skipped.contains(key.str()))
        add_leaves(std::string(key.str()), node, {file_, key.source().begin.line}, found);
    }
    const auto at = [](const Leaf& leaf) {
      const toml::source_position& begin = leaf.node->source().begin;
      return std::pair(begin.line, begin.column);
    };
    std::ranges::stable_sort(found, {}, at);
    return found;
  }

  void add_leaves(const std::string& name, const toml::node& node, const Place& place, std::vector<Leaf>& found) const {
    if (const toml::table* table = node.as_table()) {
      for (auto&& [key, inner] : *table)
        add_leaves(name + "." + std::string(key.str()), inner, {file_, key.source().begin.line}, found);
      return;
    }
    check_name(name, place);
    found.push_back({name, &node, place});
  }

  void check_name(const std::string& name, const Place& place) const {
    if (known_.contains(name)) return;
    std::vector<std::string> names;
    for (const auto& [known, takes] : known_) names.push_back(known);
    const std::string near = nearest_name(name, names);
    refuse(place,
           "`torolux " + plan_.command + "` has no option " + in_quotes(name) + " that a plan may set" +
               (near.empty() ? "; see --help, names are written without dashes" : "; did you mean '" + near + "'?"));
  }

  PlanOption option(const Leaf& leaf) const { return option(leaf.name, *leaf.node, leaf.place); }

  PlanOption option(const std::string& name, const toml::node& node, const Place& place) const {
    PlanOption result{name, "", false, place};
    if (const auto* text = node.as_string()) {
      // On a command line it is taken as TOML.
      result.value = name.starts_with("machine.") ? "'" + text->get() + "'" : text->get();
    } else if (const auto* number = node.as_integer()) {
      result.value = std::to_string(number->get());
    } else if (const auto* real = node.as_floating_point()) {
      result.value = text_of(MachineValue(real->get()));
    } else if (const auto* flag = node.as_boolean()) {
      result.value = flag->get() ? "true" : "false";
      result.flag = true;
    } else if (const auto* words = node.as_array(); words != nullptr && name == kArguments) {
      for (const toml::node& word : *words) {
        const std::string argument = option(kArguments, word, place_of(word, file_)).value;
        if (word.is_array() || argument.empty() || argument.find(' ') != std::string::npos)
          refuse(place_of(word, file_), "an argument in a plan is a text without blanks, or a number");
        result.value += (result.value.empty() ? "" : " ") + argument;
      }
    } else {
      refuse(place, "'" + name + "' must be a text, a number, or true or false");
    }
    check_taken(result);
    return result;
  }

  /// A run would take another word for its value, or not know what to do with it.
  void check_taken(const PlanOption& option) const {
    const auto known = known_.find(option.name);
    if (known == known_.end() || option.name == kArguments) return;
    if (known->second == Takes::nothing && !option.flag)
      refuse(option.place,
             "'" + option.name + "' is " + in_quotes(option.value) + "; allowed are true and false, without quotes");
    if (known->second == Takes::a_value && option.flag && option.value == "true")
      refuse(option.place, "'" + option.name + "' is true; allowed is a text or a number, or false: without it");
  }

  Axis axis(const Leaf& leaf) const {
    const toml::array* values = leaf.node->as_array();
    if (values == nullptr || values->empty())
      refuse(leaf.place, "'" + leaf.name + "' varies: it must be a list of values, [a, b, ...]");
    Axis result{leaf.name, {}};
    for (const toml::node& value : *values) result.values.push_back(option(leaf.name, value, place_of(value, file_)));
    return result;
  }

  void read_zip(const toml::table& vary) {
    const toml::node* node = vary.get("zip");
    if (node == nullptr) return;
    const Place place = place_of(*node, file_);
    const toml::array* groups = node->as_array();
    if (groups == nullptr) refuse(place, "'zip' is a list of lists of names, [[\"pes\", \"subspaces\"]]");
    std::set<std::string> seen;
    for (const toml::node& group : *groups) {
      const toml::array* names = group.as_array();
      if (names == nullptr) refuse(place, "'zip' is a list of lists of names, [[\"pes\", \"subspaces\"]]");
      std::vector<std::string> together;
      for (const toml::node& name : *names) {
        together.push_back(name.value<std::string>().value_or(""));
        check_zipped(together, place);
        if (!seen.insert(together.back()).second) refuse(place, "'" + together.back() + "' is zipped twice");
      }
      if (together.size() > 1) plan_.zip.push_back(together);
    }
  }

  /// The last one against the first.
  void check_zipped(const std::vector<std::string>& names, const Place& place) const {
    const auto values = [&](const std::string& name) {
      const auto found = std::ranges::find(plan_.vary, name, &Axis::name);
      if (found == plan_.vary.end()) refuse(place, "'zip' names '" + name + "', which does not vary");
      return found->values.size();
    };
    if (values(names.back()) != values(names.front()))
      refuse(place, "'zip' needs lists of one length; '" + names.front() + "' has " +
                        std::to_string(values(names.front())) + " values and '" + names.back() + "' has " +
                        std::to_string(values(names.back())));
  }

  void read_report(TomlTable table) {
    Report& report = plan_.report;
    report.x = table.text("x").value_or("");
    report.by = table.text("by").value_or("");
    report.title = table.text("title").value_or("");
    report.log_x = table.flag("log_x").value_or(false);
    report.log_y = table.flag("log_y").value_or(false);
    report.y = names_at(table, "y");
    for (const auto& [key, name] : {std::pair("x", report.x), std::pair("by", report.by)})
      if (!name.empty()) report.lines.emplace(name, table.place(key).line);
    if (const toml::table* baseline = table.table("baseline")) {
      report.lines.emplace("baseline", table.place("baseline").line);
      for (const Leaf& leaf : leaves(*baseline, {})) report.baseline[leaf.name] = option(leaf).value;
    }
    table.finish();
  }

  /// One text or a list of them.
  std::vector<std::string> names_at(TomlTable& table, const char* key) {
    const toml::table* report = root_.get("report")->as_table();
    const toml::node* node = report->get(key);
    if (node == nullptr || node->is_string()) {
      const auto text = table.text(key);
      if (!text) return {};
      plan_.report.lines.emplace(*text, place_of(*node, file_).line);
      return {*text};
    }
    table.known(key);
    std::vector<std::string> names;
    const toml::array* list = node->as_array();
    if (list == nullptr) refuse(place_of(*node, file_), std::string("[report] '") + key + "' is a list of names");
    for (const toml::node& name : *list) {
      if (!name.is_string()) refuse(place_of(name, file_), std::string("[report] '") + key + "' is a list of names");
      names.push_back(name.value<std::string>().value_or(""));
      if (names.back().empty()) refuse(place_of(name, file_), std::string("[report] '") + key + "' has an empty name");
      if (std::ranges::count(names, names.back()) > 1)
        refuse(place_of(name, file_), std::string("[report] '") + key + "' names '" + names.back() + "' twice");
      plan_.report.lines.emplace(names.back(), place_of(name, file_).line);
    }
    return names;
  }

  void check_once() const {
    std::set<std::string> names;
    for (const auto* axes : {&plan_.vary, &plan_.vary_one}) {
      for (const Axis& one : *axes) {
        if (!names.insert(one.name).second)
          refuse(one.values.front().place, "'" + one.name + "' varies in [vary] and in [vary_one]");
      }
    }
  }

  const toml::table& root_;
  std::string file_;
  std::map<std::string, Takes> known_;  ///< options of the command
  Plan plan_;
};

}  // namespace

Plan parse_plan(std::string_view text, const std::filesystem::path& file) {
  const toml::table root = parse_toml(text, file.string());
  return PlanReader(root, file).read();
}

Plan read_plan(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file(file, kMostPlanBytes);
  return parse_plan({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

}  // namespace torolux::study
