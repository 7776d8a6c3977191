#include <fstream>
#include <map>
#include <regex>

#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

// Every key that a study may have, with what holds without it.
std::map<std::string, std::string> KnownKeys() {
  const StudyFolder folder;
  folder.Write("rows.csv", "trial\none\n");
  const std::string text = "config = \"" + std::string(HYDRO_CONFIG) + R"(/demo.toml"
draws = 1
[[grid]]
key = "g"
values = [1]
[list]
file = "rows.csv"
[[draw]]
key = "u"
distribution = "uniform"
min = 0
max = 1
[[draw]]
key = "n"
distribution = "normal"
mean = 0
standard_deviation = 1
[[draw]]
key = "c"
distribution = "choice"
values = [1]
[[draw]]
key = "model:b"
distribution = "uncertainty"
[[step]]
run = ["true"]
[collect]
x = { from = "x.json:/x" }
)";
  std::vector<settings::AskedKey> asked;
  ReadStudy(folder.Write("study.toml", text), &asked);
  std::map<std::string, std::string> known;
  for (const settings::AskedKey& key : asked) {
    const std::string standard = key.required ? "required" : key.standard;
    if (key.section == "collect.x") {
      known["collect.NAME." + key.key] = standard;
    } else if (key.section != "collect") {
      known[key.section.empty() ? key.key : key.section + "." + key.key] = standard;
    }
  }
  // Sections that have a table of their own.
  for (const char* section : {"grid", "list", "draw", "step", "collect", "report"}) known.erase(section);
  known["list.keys"] = known["list.rows"] = "";  // read where there is no list.file
  known["name"] = "the file's name";
  known["grid.steps"] = "none";
  return known;
}

// The keys in the tables of docs/studies.md below a heading that names their section, and their defaults.
std::map<std::string, std::string> KeysOnPage() {
  std::ifstream page(HYDRO_STUDIES_PAGE);
  std::map<std::string, std::string> keys;
  std::string section;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    std::smatch match;
    if (line.starts_with("## ")) {
      section = std::regex_search(line, match, std::regex(R"(`\[+([\w.]+)\]+`)")) ? match[1].str() + "." : "";
      in_table = false;
    }
    if (line.starts_with("| key | default |")) in_table = true;
    if (!line.starts_with("|")) in_table = false;
    if (!in_table || !std::regex_search(line, match, std::regex(R"(^\| `([\w`, ]+)` \| ([^|]*) \|)")))
      continue;
    const std::string names = match[1], standard = match[2];
    const std::regex name(R"(\w+)");
    for (std::sregex_iterator i(names.begin(), names.end(), name), end; i != end; ++i)
      keys[section + i->str()] = standard;
  }
  return keys;
}

// Tests that docs/studies.md has every key that the reader knows and no other, with the reader's defaults.
TEST(StudiesPageTest, HasEveryKey) {
  const std::map<std::string, std::string> known = KnownKeys();
  std::map<std::string, std::string> on_page;
  for (const auto& [key, standard] : KeysOnPage())
    on_page[std::regex_replace(key, std::regex("^collect\\."), "collect.NAME.")] = standard;
  for (const auto& [key, standard] : known) {
    ASSERT_TRUE(on_page.contains(key)) << key << ": no row on the page";
    if (standard.empty() || standard == "\"\"") continue;
    EXPECT_THAT(on_page[key], testing::AnyOf(standard, "`" + standard + "`")) << key;
  }
  for (const auto& [key, standard] : on_page)
    EXPECT_TRUE(known.contains(key)) << key << ": no key of the code";
}

}  // namespace
}  // namespace hydro::batch
