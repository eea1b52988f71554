// SPDX-License-Identifier: MIT
// C++ on the kit: constructors of static objects, containers, virtual functions, destructors at exit.
#include <torolux.h>

#include <algorithm>
#include <cstdio>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace {

int constructed = 0;

class Early {
 public:
  Early() { number_ = ++constructed * 10; }
  ~Early() { std::printf("PE %u: destroyed %d\n", torolux_pe(), number_); }
  int number() const { return number_; }

 private:
  int number_ = 0;
};
Early first;
Early second;

class Shape {
 public:
  virtual ~Shape() = default;
  virtual int corners() const = 0;
};
class Square : public Shape {
 public:
  int corners() const override { return 4; }
};

Early& third() {
  static Early once;
  return once;
}

}  // namespace

int main() {
  std::map<std::string, int> by_name = {{"two", 2}, {"one", 1}, {"three", 3}};
  std::unordered_map<int, std::string> by_number;
  for (const auto& [name, number] : by_name) by_number[number] = name;
  std::vector<int> numbers(1000);
  for (int i = 0; i < 1000; ++i) numbers[static_cast<std::size_t>(i)] = i * 7919 % 1000;
  std::sort(numbers.begin(), numbers.end());
  std::list<int> list(numbers.begin(), numbers.begin() + 3);
  const std::unique_ptr<Shape> shape = std::make_unique<Square>();
  std::string long_text;
  for (const auto& [name, number] : by_name) long_text += name + "=" + std::to_string(number) + " ";
  std::printf("%d %d %d %s%s %d %zu %d\n", first.number(), second.number(), third().number(), long_text.c_str(),
              by_number.at(3).c_str(), numbers[999], list.size(), shape->corners());
  return 0;
}
