// SPDX-License-Identifier: MIT
// Proves: the report holds the statistics, exactly, and nothing in them ends the script or the title that holds them;
// the bundle is small and may stand in a page.
#include "host_tools/report/html_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host_tools/web/bundle.hpp"

namespace torolux {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

std::string data_of(const std::string& page) {
  return between(page, "<script type=\"application/json\" id=\"data\">", "</script>");
}

/// As the page's script undoes it.
json unpacked(const json& packed) {
  json result = packed;
  if (packed.is_object() && packed.contains("$rows")) {
    result = json::array();
    for (std::size_t i = 0; i < packed["$rows"]; ++i) result.push_back(json::object());
    for (const auto& [key, column] : packed["$columns"].items()) {
      const json values = unpacked(column);
      for (std::size_t i = 0; i < values.size(); ++i) result[i][key] = values[i];
    }
  } else if (packed.is_structured()) {
    for (json& value : result) value = unpacked(value);
  }
  return result;
}

/// Tables within tables, rows that are no table, and what could end a script.
json statistics() {
  json stats = {{"version", "</script><script>alert(1)</script><!--"}, {"numbers", {1, 2, 3}}, {"none", json::array()}};
  stats["stages"] = json::array({{{"name", "load"}}, {{"name", "radiosity"}}});
  for (const double i : {1.0, 0.1, 1e-300}) {
    stats["pes"].push_back({{"busy", i}, {"waits", {{"copy", 2 * i}, {"bus", nullptr}}}, {"list", {i, "<"}}});
    stats["rows"].push_back({{"key" + std::to_string(i), 1}});
  }
  return stats;
}

MachineFigures figures() {
  MachineFigures figures;
  for (Cycles i = 1; i <= 2; ++i) {
    StageFigures stage;
    RouterFigures router;
    router.links[2].busy = 10 * i;
    router.links[2].packets = i;
    stage.figures.routers = {router, router};
    figures.stages.push_back(stage);
  }
  return figures;
}

TEST(HtmlReport, HoldsTheStatisticsExactly) {
  const MachineFigures machine = figures();
  const std::string text = statistics().dump();
  json data = unpacked(json::parse(data_of(report_html({"a", text, machine, nullptr, {}}))));
  EXPECT_EQ(data["statistics"]["stages"][1]["links"][0]["south"]["busy_cycles"], 20);
  EXPECT_EQ(data["statistics"]["stages"][0]["links"][1]["south"]["packets"], 1);
  for (json& stage : data["statistics"]["stages"]) stage.erase("links");
  EXPECT_EQ(data["statistics"], statistics());
  EXPECT_FALSE(data.contains("picture"));
}

TEST(HtmlReport, LetsNothingEndWhatHoldsIt) {
  const MachineFigures machine = figures();
  const std::string text = statistics().dump();
  const std::string page = report_html({"</title><script>&\xFF", text, machine, nullptr, {}});
  EXPECT_THAT(data_of(page), Not(HasSubstr("<")));
  EXPECT_EQ(between(page, "<title>", "</title>"), "&lt;/title>&lt;script>&amp;\xFF - Torolux");
  EXPECT_TRUE(json::accept(data_of(page))) << "though the title is no UTF-8";
}

TEST(HtmlReport, ShowsThePictureFromWithin) {
  const Picture picture{kReportPictureEdge + 1, 1,
                        std::vector<std::array<float, 3>>(kReportPictureEdge + 1, {1, 1, 1})};
  const MachineFigures machine = figures();
  const std::string text = statistics().dump();
  const json shown = json::parse(data_of(report_html({"a", text, machine, &picture, {}})))["picture"];
  EXPECT_EQ(shown["width"], kReportPictureEdge + 1);
  EXPECT_EQ(shown["shown_width"], kReportPictureEdge / 2 + 1);
  // The signature of a PNG, 89 50 4E 47 0D 0A 1A 0A, in base 64.
  EXPECT_THAT(shown["png"].get<std::string>(), testing::StartsWith("data:image/png;base64,iVBORw0KGgo"));
}

TEST(HtmlReport, BundleIsSmallAndMayStandInAPage) {
  EXPECT_GT(report_script().size(), 10'000U);
  EXPECT_LT(report_script().size(), 110'000U);
  for (const std::string_view text : {report_script(), report_style()}) {
    EXPECT_EQ(text.find("</s"), std::string_view::npos);
    EXPECT_EQ(text.find("<!--"), std::string_view::npos);
    EXPECT_EQ(text.find("http:"), text.find("http://www.w3.org")) << "names of SVG and MathML alone";
    EXPECT_EQ(text.find("https:"), std::string_view::npos);
    EXPECT_EQ(text.find("@import"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace torolux
