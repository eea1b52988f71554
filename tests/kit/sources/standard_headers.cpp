// SPDX-License-Identifier: MIT
// What of the standard library's headers works on a PE, each used once: nothing enters; a line of numbers leaves that
// does not depend on how it was compiled.
#include <torolux.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <bitset>
#include <charconv>
#include <chrono>
#include <cmath>
#include <compare>
#include <complex>
#include <concepts>
#include <cstdio>
#include <deque>
#include <forward_list>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <random>
#include <ranges>
#include <set>
#include <span>
#include <stack>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <valarray>
#include <variant>
#include <vector>

namespace {

int containers() {
  std::vector<int> numbers(100);
  std::iota(numbers.begin(), numbers.end(), 0);
  std::mt19937 generator(torolux_pe() + 1);
  std::shuffle(numbers.begin(), numbers.end(), generator);
  std::stable_sort(numbers.begin(), numbers.end(), std::greater<>());
  const std::deque<int> deque(numbers.begin(), numbers.end());
  const std::list<int> list(deque.begin(), deque.end());
  const std::forward_list<int> forward(list.begin(), list.end());
  const std::set<int> set(forward.begin(), forward.end());
  const std::unordered_set<int> hashed(set.begin(), set.end());
  std::map<std::string, int> map = {{"one", 1}, {"two", 2}};
  map["three"] = 3;
  std::unordered_map<std::string, int> by_name(map.begin(), map.end());
  std::priority_queue<int> queue(numbers.begin(), numbers.end());
  std::stack<int> stack;
  stack.push(by_name.at("two"));
  const std::valarray<int> values = {1, 2, 3};
  return numbers[0] + queue.top() + static_cast<int>(hashed.size()) + stack.top() + map.rbegin()->second + values.sum();
}

int views() {
  const std::array<int, 6> array = {5, 3, 8, 1, 9, 2};
  const std::span<const int> part = std::span(array).subspan(1, 4);
  int sum = 0;
  for (const int even : part | std::views::filter([](int n) { return n % 2 == 0; })) sum += even;
  const std::string_view text = "123 and more";
  int parsed = 0;
  std::from_chars(text.data(), text.data() + 3, parsed);
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), parsed * 2);
  return sum + std::reduce(part.begin(), part.end()) + static_cast<int>(end.ptr - digits.data()) +
         static_cast<int>(std::ranges::max(array));
}

struct Visitor {
  int operator()(int number) const { return number; }
  int operator()(const std::string& text) const { return static_cast<int>(text.size()); }
};

int values() {
  const std::variant<int, std::string> variant = std::string("four");
  const std::optional<int> nothing;
  const auto [first, second] = std::make_tuple(3, 4);
  const std::function<int(int)> twice = [](int n) { return 2 * n; };
  const auto unique = std::make_unique<int>(5);
  const auto shared = std::make_shared<int>(6);
  std::atomic<int> atomic = 7;
  atomic.fetch_add(1);
  const std::bitset<20> bits(0xF0F);
  const std::chrono::milliseconds time = std::chrono::seconds(2);
  return std::visit(Visitor(), variant) + nothing.value_or(1) + first + second + twice(2) + *unique + *shared + atomic +
         static_cast<int>(bits.count()) + std::popcount(255U) + static_cast<int>(time.count() / 1000);
}

std::string text() {
  std::string line = "text " + std::to_string(42) + " that is too long for the small string";
  line.replace(0, 4, "words");
  return line.substr(0, 8);
}

}  // namespace

int main() {
  const std::complex<float> turned = std::polar(2.0F, std::numbers::pi_v<float> / 4) * std::complex<float>(0, 1);
  std::printf("%d %d %d '%s' %.6f %.6f %.3e\n", containers(), views(), values(), text().c_str(),
              static_cast<double>(turned.real()), std::cbrt(2.0), std::lgamma(10.5));
}
