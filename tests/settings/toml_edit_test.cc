#include "settings/toml/toml_edit.h"

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

const std::string kText = R"(# A stack.
top = 1
[position]
c1 = 6000.0   # stiffness
c2 = 350  # damping # "twice"

name = "a # no comment"  # a comment
[reference]   # what to follow
steps = [
  [0.2, 0.3],  # first
  [2.2, -0.2],
]  # all
kind = 'steps'
[[process]]
c1 = 5
)";

TEST(EditToml, ReplacesValuesAndLeavesAllElse) {
  std::string expected = Replaced(kText, "c1 = 6000.0   # stiffness", "c1 = 9000     # stiffness");
  expected = Replaced(expected, "\"a # no comment\"  # a", "\"b\"               # a");
  EXPECT_EQ(EditToml(kText, "x.toml", {{"position.c1", "9000"}, {"position.name", "\"b\""}}, {}), expected);
}

TEST(EditToml, ReplacesAValueOfSeveralLines) {
  EXPECT_EQ(EditToml(kText, "x.toml", {{"reference.steps", "[[0, 0.1]]"}}, {}),
            Replaced(kText, "steps = [\n  [0.2, 0.3],  # first\n  [2.2, -0.2],\n]  # all",
                     "steps = [[0, 0.1]]  # all"));
}

TEST(EditToml, AddsAndRemoves) {
  const std::string edited =
      EditToml(kText, "x.toml", {{"position.derivative", "'error'"}, {"limits.pressure", "1500"}},
               {"position.c2", "reference.steps"});
  std::string expected = Replaced(kText, "c2 = 350  # damping # \"twice\"\n", "");
  expected = Replaced(expected, "# a comment\n", "# a comment\nderivative = 'error'\n");
  expected = Replaced(expected, "steps = [\n  [0.2, 0.3],  # first\n  [2.2, -0.2],\n]  # all\n", "");
  EXPECT_EQ(edited, expected + "\n[limits]\npressure = 1500\n");
}

// Tests that a comment that is given takes the place of the former one, or stands beside a value that had
// none.
TEST(EditToml, ReplacesComments) {
  std::string expected = Replaced(kText, "c1 = 6000.0   # stiffness", "c1 = 9000     # psi/rad, was 6000");
  expected = Replaced(expected, "]  # all", "]  # all\nsigma = 3  # new");
  expected = Replaced(expected, "kind = 'steps'\n", "kind = 'steps'  # as it was\n");
  expected = Replaced(expected, "]  # all\nsigma = 3  # new\nkind = 'steps'  # as it was\n",
                      "]  # all\nkind = 'steps'  # as it was\nsigma = 3  # new\n");
  EXPECT_EQ(EditToml(kText, "x.toml",
                     {{"position.c1", "9000"}, {"reference.kind", "'steps'"}, {"reference.sigma", "3"}}, {},
                     {{"position.c1", "psi/rad, was 6000"},
                      {"reference.kind", "as it was"},
                      {"reference.sigma", "new"},
                      {"position.c2", "not changed"}}),
            expected);
}

TEST(EditToml, FindsDottedKeys) {
  EXPECT_EQ(EditToml("position.c1 = 1\nposition.c2 = 2\n", "x.toml", {{"position.c1", "5"}}, {}),
            "position.c1 = 5\nposition.c2 = 2\n");
}

// Tests that a document in which a value cannot be found is refused, not changed wrongly.
TEST(EditToml, RefusesWhatItCannotFind) {
  for (const char* text : {"position = { c1 = 1, c2 = 2 }\n", "[position]\n\"c1\" = 1\nc2 = 2\n",
                           "[position]\nc1 = 1\ntext = \"\"\"\n[position]\nc1 = 3\n\"\"\"\n"}) {
    EXPECT_THAT(InputErrorOf([&] {
                  const std::string edited = EditToml(text, "x.toml", {{"position.c1", "5"}}, {});
                  ADD_FAILURE() << edited;
                }),
                ::testing::HasSubstr("x.toml:"))
        << text;
  }
}

}  // namespace
}  // namespace hydro::settings
