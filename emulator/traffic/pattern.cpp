// SPDX-License-Identifier: MIT
// The patterns, one class each; their definitions are those of Dally and Towles (Principles and Practices of
// Interconnection Networks, 2004, table 3.1), widened to tori of any shape.
#include "emulator/traffic/pattern.hpp"

#include <array>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"

namespace torolux {

namespace {

std::string text_of(TorusShape shape) {
  return std::to_string(shape.columns()) + "x" + std::to_string(shape.rows()) + " PEs";
}

/// To each with the same chance.
class Uniform final : public TrafficPattern {
 public:
  Uniform(TorusShape shape, bool to_itself) : nodes_(shape.routers()), to_itself_(to_itself) {}
  unsigned destination(unsigned from, std::uint32_t random) const override {
    const unsigned choices = to_itself_ ? nodes_ : nodes_ - 1;
    const auto choice = static_cast<unsigned>(std::uint64_t{random} * choices >> 32U);
    return to_itself_ || choice < from ? choice : choice + 1;
  }

 private:
  unsigned nodes_;
  bool to_itself_;
};

/// Nearly half a ring up, in both dimensions: (k - 1) / 2 of k.
class Tornado final : public TrafficPattern {
 public:
  explicit Tornado(TorusShape shape) : shape_(shape) {
    if (shape.columns() < 3 && shape.rows() < 3) {
      throw InputError(text_of(shape) + ": tornado traffic goes (k - 1) / 2 PEs along a ring of k; one dimension " +
                       "must have at least 3");
    }
  }
  unsigned destination(unsigned from, std::uint32_t /*random*/) const override {
    const unsigned x = (from % shape_.columns() + (shape_.columns() - 1) / 2) % shape_.columns();
    const unsigned y = (from / shape_.columns() + (shape_.rows() - 1) / 2) % shape_.rows();
    return y * shape_.columns() + x;
  }

 private:
  TorusShape shape_;
};

/// (x, y) to (y, x).
class Transpose final : public TrafficPattern {
 public:
  explicit Transpose(TorusShape shape) : side_(shape.columns()) {
    if (shape.columns() != shape.rows()) {
      throw InputError(text_of(shape) +
                       ": transpose traffic sends from (x, y) to (y, x); give as many rows as columns");
    }
  }
  unsigned destination(unsigned from, std::uint32_t /*random*/) const override {
    return from % side_ * side_ + from / side_;
  }

 private:
  unsigned side_;
};

/// (x, y) to (P - 1 - x, Q - 1 - y): with powers of two, the complement of all bits.
class BitComplement final : public TrafficPattern {
 public:
  explicit BitComplement(TorusShape shape) : nodes_(shape.routers()) {}
  unsigned destination(unsigned from, std::uint32_t /*random*/) const override { return nodes_ - 1 - from; }

 private:
  unsigned nodes_;
};

/// All to the one in the middle.
class Hotspot final : public TrafficPattern {
 public:
  explicit Hotspot(TorusShape shape)
      : spot_(shape.rows() / 2 * shape.columns() + shape.columns() / 2), senders_(shape.routers() - 1) {}
  unsigned destination(unsigned /*from*/, std::uint32_t /*random*/) const override { return spot_; }
  unsigned senders_to_one() const override { return senders_; }

 private:
  unsigned spot_, senders_;
};

}  // namespace

const std::vector<std::string_view>& traffic_pattern_names() {
  static const std::vector<std::string_view> kNames = {"uniform", "tornado", "transpose", "bit-complement", "hotspot"};
  return kNames;
}

std::unique_ptr<TrafficPattern> make_traffic_pattern(std::string_view name, TorusShape shape, bool to_itself) {
  if (shape.routers() < 2) throw InputError(text_of(shape) + ": traffic needs at least two PEs");
  if (name == "uniform") return std::make_unique<Uniform>(shape, to_itself);
  if (name == "tornado") return std::make_unique<Tornado>(shape);
  if (name == "transpose") return std::make_unique<Transpose>(shape);
  if (name == "bit-complement") return std::make_unique<BitComplement>(shape);
  if (name == "hotspot") return std::make_unique<Hotspot>(shape);
  const auto& names = traffic_pattern_names();
  throw UsageError(no_such_name(name, "no pattern of traffic", {names.begin(), names.end()}));
}

}  // namespace torolux
