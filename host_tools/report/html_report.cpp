// SPDX-License-Identifier: MIT
// The page's parts are put together: style and script as bundled, data as JSON, the picture as a PNG in a data address.
#include "host_tools/report/html_report.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/errors.hpp"
#include "host_tools/files/extension.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/picture/reduce.hpp"
#include "host_tools/web/bundle.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

/// RFC 4648, section 4.
std::string base64(std::span<const std::byte> bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // OpenSSL ends it with a zero byte
  const int length =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

bool same_keys(const Json& a, const Json& b) {
  return a.is_object() && b.is_object() && a.size() == b.size() &&
         std::equal(a.items().begin(), a.items().end(), b.items().begin(),
                    [](const auto& x, const auto& y) { return x.key() == y.key(); });
}

bool is_table(const Json& json) {
  return json.is_array() && json.size() > 1 && json.front().is_object() && !json.front().empty() &&
         std::all_of(json.begin(), json.end(), [&](const Json& row) { return same_keys(json.front(), row); });
}

/// Keys once for a whole column: a fifth of the bytes for hundreds of PEs.
Json packed(const Json& json) {
  if (is_table(json)) {
    Json columns = Json::object();
    for (const auto& [key, unused] : json.front().items()) {
      Json column = Json::array();
      for (const Json& row : json) column.push_back(row.at(key));
      columns[key] = packed(column);
    }
    return {{"$rows", json.size()}, {"$columns", std::move(columns)}};
  }
  Json result = json;
  if (json.is_structured()) {
    for (Json& value : result) value = packed(value);
  }
  return result;
}

/// What the page shows of a link in one stage.
Json link_json(const LinkFigures& link) {
  return {
      {"busy_cycles", link.busy}, {"stalled_cycles", link.stalled}, {"packets", link.packets}, {"flits", link.flits}};
}

Json links_json(const MachineFigures& stage) {
  Json json = Json::array();
  for (const RouterFigures& router : stage.routers) {
    Json one;
    for (std::size_t i = 0; i < kLinks; ++i) one[std::string(kLinkNames[i])] = link_json(router.links[i]);
    json.push_back(std::move(one));
  }
  return json;
}

Json picture_json(const Picture& picture, const ToneMapping& tone) {
  const ReducedPicture small = reduce(picture, tone, kReportPictureEdge);
  const std::vector<std::byte> png = encode_png(small.width, small.height, small.bytes);
  return {{"width", picture.width},
          {"height", picture.height},
          {"shown_width", small.width},
          {"shown_height", small.height},
          {"png", "data:image/png;base64," + base64(png)}};
}

std::string data_text(const ReportInput& input) {
  Json data;
  data["title"] = input.title;
  data["statistics"] = Json::parse(input.statistics);
  Json& stages = data["statistics"]["stages"];
  for (std::size_t i = 0; i < stages.size() && i < input.machine.stages.size(); ++i)
    stages[i]["links"] = links_json(input.machine.stages[i].figures);
  data = packed(data);
  if (input.picture != nullptr) data["picture"] = picture_json(*input.picture, input.tone);
  if (!input.profile.empty()) data["profile"] = Json::parse(input.profile);
  const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

void check_report_writable(const std::filesystem::path& file) {
  const std::string extension = small_extension(file);
  if (!extension.empty() && extension != ".html" && extension != ".htm")
    throw UsageError("--report: " + file.string() + ": a report is a page of HTML, in no other format; call it " +
                     std::filesystem::path(file).replace_extension(".html").string());
  check_file_writable(file);
}

std::string report_html(const ReportInput& input) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      // Nothing is fetched, whatever the data say.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n<title>";
  page += escaped(input.title) + " - Torolux</title>\n<style>";
  page += report_style();
  page +=
      "</style>\n</head>\n<body>\n<div id=\"page\"></div>\n<noscript>This report needs JavaScript; it fetches "
      "nothing.</noscript>\n<script type=\"application/json\" id=\"data\">";
  page += data_text(input);
  page += "</script>\n<script>";
  page += report_script();
  page += "</script>\n</body>\n</html>\n";
  return page;
}

}  // namespace torolux
