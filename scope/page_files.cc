#include "scope/page_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

#include "base/input_error.h"
#include "base/text_file.h"

namespace hydro::scope {
namespace {

constexpr std::string_view kAssets = "/assets/";
constexpr std::string_view kPlotLibrary = "uplot/";

struct Type {
  std::string_view ending;
  const char* type;
};
constexpr std::array<Type, 5> kTypes{{{".html", "text/html; charset=utf-8"},
                                      {".js", "text/javascript; charset=utf-8"},
                                      {".css", "text/css; charset=utf-8"},
                                      {".svg", "image/svg+xml"},
                                      {".png", "image/png"}}};

const char* TypeOf(const std::string& name) {
  const auto type =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& t) { return name.ends_with(t.ending); });
  return type == kTypes.end() ? nullptr : type->type;
}

// No way out of the folder, and nothing hidden in it.
bool IsPlain(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_' || c == '/';
  });
  return plain && !name.starts_with('.') && !name.starts_with('/') && name.find("/.") == std::string::npos &&
         name.find("..") == std::string::npos && !name.starts_with("node_modules") &&
         !name.starts_with("tests");
}

constexpr char kNoPage[] =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>hydro-scope</title>"
    "<p>This hydro-scope was built without its page. Its web socket and its files work.</p></html>\n";

}  // namespace

PageFiles::PageFiles(std::string folder) : folder_(std::move(folder)) {
  if (!folder_.empty() && !std::filesystem::is_regular_file(folder_ + "/index.html")) {
    throw InputError("--page " + folder_ +
                     ": found no index.html there, allowed is the folder of the page's sources");
  }
}

bool PageFiles::Has(const std::string& path) { return path == "/" || path.starts_with(kAssets); }

std::optional<std::string> PageFiles::Find(const std::string& name) const {
  if (folder_.empty()) {
    for (unsigned long i = 0; i < kPageFileCount; ++i) {
      if (name == kPageFiles[i].name) {
        return std::string(reinterpret_cast<const char*>(kPageFiles[i].bytes), kPageFiles[i].size);
      }
    }
    return std::nullopt;
  }
  if (!IsPlain(name)) return std::nullopt;
  const bool library = name.starts_with(kPlotLibrary);
  const std::string file =
      folder_ + "/" + (library ? "node_modules/uplot/dist/" + name.substr(kPlotLibrary.size()) : name);
  if (!std::filesystem::is_regular_file(file)) return std::nullopt;
  return ReadTextFile(file);
}

Response PageFiles::Answer(const std::string& path) const {
  const std::string name = path == "/" ? "index.html" : path.substr(kAssets.size());
  const char* const type = TypeOf(name);
  auto bytes = type == nullptr ? std::nullopt : Find(name);
  if (!bytes && path == "/") bytes = kNoPage;
  if (!bytes) return ErrorResponse(404, "the page has no file " + Printable(path));
  Response response;
  response.type = type;
  response.body = std::move(*bytes);
  return response;
}

}  // namespace hydro::scope
