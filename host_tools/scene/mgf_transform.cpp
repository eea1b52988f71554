// SPDX-License-Identifier: MIT
// Works out MGF's transforms.
#include "host_tools/scene/mgf_transform.hpp"

#include <charconv>
#include <cmath>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/rotation.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr const char* kForm =
    "-t X Y Z, -rx, -ry or -rz DEGREES, -s FACTOR, -mx, -my, -mz, -i COUNT (repeat what follows), -a COUNT (copies)";
/// More are more than anybody means; and twice as much still has room.
constexpr std::uint64_t kMostCopies = std::uint64_t{1} << 62U;
constexpr std::size_t kMostDepth = 1000;
constexpr std::size_t kMostCounts = 100;

MgfPlacement to_the_power(MgfPlacement base, std::uint64_t times) {
  MgfPlacement result;
  for (; times > 0; times >>= 1U) {
    if ((times & 1U) != 0) result = joined(result, base);
    base = joined(base, base);
  }
  return result;
}

bool in_range(const MgfPlacement& p) {
  const auto bearable = [](double x) { return std::abs(x) <= kMostCoordinate; };
  for (std::size_t row = 0; row < 3; ++row) {
    if (!bearable(p.move[row])) return false;
    for (const double x : p.rows[row])
      if (!bearable(x)) return false;
  }
  return p.scale >= 1e-15 && p.scale <= kMostCoordinate;
}

}  // namespace

Vec3d MgfPlacement::point(const Vec3d& p) const {
  return {vec::dot(rows[0], p) + move[0], vec::dot(rows[1], p) + move[1], vec::dot(rows[2], p) + move[2]};
}

Vec3d MgfPlacement::direction(const Vec3d& d) const {
  return {vec::dot(rows[0], d) / scale, vec::dot(rows[1], d) / scale, vec::dot(rows[2], d) / scale};
}

MgfPlacement joined(const MgfPlacement& inner, const MgfPlacement& outer) {
  MgfPlacement both;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      both.rows[row][column] = 0;
      for (std::size_t i = 0; i < 3; ++i) both.rows[row][column] += outer.rows[row][i] * inner.rows[i][column];
    }
  both.move = outer.point(inner.move);
  both.scale = inner.scale * outer.scale;
  both.mirrored = inner.mirrored != outer.mirrored;
  return both;
}

/// Hands out one argument after the other.
class MgfTransforms::Arguments {
 public:
  Arguments(const MgfStatement& statement, std::size_t first) : statement_(statement), next_(first) {}

  bool more() const { return next_ < statement_.count(); }
  std::string_view peek() const { return statement_.word(next_); }
  std::string_view word() {
    if (!more()) statement_.refuse_with("the transform ends too early; allowed are " + std::string(kForm));
    return statement_.word(next_++);
  }
  double number() { return read_number(word(), statement_.place()); }
  std::uint64_t count() {
    const std::string_view text = word();
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > kMostCopies)
      statement_.refuse_with(in_quotes(text) + " is not a whole number; a count of copies is one from 1 on");
    return value;
  }
  [[noreturn]] void refuse_word(std::string_view text) const {
    statement_.refuse_with(in_quotes(text) + " is not a transform; allowed are " + kForm);
  }
  const MgfStatement& statement() const { return statement_; }

 private:
  const MgfStatement& statement_;
  std::size_t next_;
};

MgfTransforms::Step MgfTransforms::read_step(Arguments& arguments) {
  const std::string_view text = arguments.word();
  if (text == "-t") {
    const double x = arguments.number();
    const double y = arguments.number();
    return {Kind::move, 0, {x, y, arguments.number()}};
  }
  if (text == "-s") {
    const double factor = arguments.number();
    if (factor == 0) arguments.statement().refuse_with("a scale of zero: nothing would be left");
    return {Kind::scale, 0, {factor, 0, 0}};
  }
  const bool turns = text.starts_with("-r");
  const bool mirrors = text.starts_with("-m");
  if ((turns || mirrors) && text.size() == 3 && text[2] >= 'x' && text[2] <= 'z') {
    const auto axis = static_cast<std::size_t>(text[2] - 'x');
    return turns ? Step{Kind::turn, axis, {arguments.number(), 0, 0}} : Step{Kind::mirror, axis, {0, 0, 0}};
  }
  arguments.refuse_word(text);
}

MgfPlacement MgfTransforms::placement_of(const Step& step) {
  MgfPlacement p;
  switch (step.kind) {
    case Kind::move:
      p.move = step.values;
      break;
    case Kind::scale:
      // A negative factor mirrors in the centre: all three axes.
      for (std::size_t i = 0; i < 3; ++i) p.rows[i][i] = step.values[0];
      p.scale = std::abs(step.values[0]);
      p.mirrored = step.values[0] < 0;
      break;
    case Kind::mirror:
      p.rows[step.axis][step.axis] = -1;
      p.mirrored = true;
      break;
    case Kind::turn:
      p.rows = rotation(step.axis, step.values[0]);
      break;
  }
  return p;
}

void MgfTransforms::place(Open& open) {
  MgfPlacement total;
  for (const Group& group : open.groups) total = joined(total, group.all);
  const MgfPlacement& outer = &open == &open_.front() ? none_ : open_[open_.size() - 2].placement;
  open.placement = joined(total, outer);
  if (!in_range(open.placement))
    refuse(open.place, "the transform moves or scales things beyond 1e-15 to 1e15; use other units");
}

void MgfTransforms::open(const MgfStatement& statement, std::size_t first) {
  if (open_.size() == kMostDepth)
    statement.refuse_with(
        "more than 1000 transforms one inside the other; close some (xf without arguments), or join them");
  Open fresh{{Group{1}}, {}, statement.place()};
  Arguments arguments(statement, first);
  while (arguments.more()) {
    const std::string_view text = arguments.peek();
    if (text == "-a" || text == "-i") {
      arguments.word();
      const std::uint64_t count = arguments.count();
      if (text == "-a" && count == 0) statement.refuse_with("an array of no copies; -a COUNT is a number from 1 on");
      if (fresh.groups.size() > kMostCounts)
        statement.refuse_with(
            "more than 100 arrays and repetitions (-a, -i) in one transform; put some into a transform around it");
      fresh.groups.push_back({text == "-a" ? 0 : count, text == "-a" ? count : 0});
    } else {
      MgfPlacement& once = fresh.groups.back().once;
      once = joined(once, placement_of(read_step(arguments)));
    }
  }
  for (Group& group : fresh.groups) group.all = to_the_power(group.once, group.times);
  open_.push_back(std::move(fresh));
  place(open_.back());
}

bool MgfTransforms::next_copy() {
  Open& innermost = open_.back();
  for (std::size_t i = innermost.groups.size(); i-- > 0;) {
    Group& group = innermost.groups[i];
    if (group.copies == 0) continue;
    group.times = (group.times + 1) % group.copies;
    group.all = to_the_power(group.once, group.times);
    if (group.times > 0) {
      place(innermost);
      return true;
    }
  }
  open_.pop_back();
  return false;
}

}  // namespace torolux
