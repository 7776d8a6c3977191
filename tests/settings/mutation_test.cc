#include <random>

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

const char kFullConfig[] = R"(# a comment
[model]
file = "model.toml"
shaft = "driven"
[model.motion]
kind = "csv"
points = [[0, 0.0], [1.5, 0.2], [2, -0.1]]
interpolation = "cubic"
[bus]
url = "udpm://239.255.76.67:7667?ttl=0"
[time]
mode = "lockstep"
duration_s = 1.0
[plant]
rate_hz = 5_000
[pressure]
rate_hz = "every_tick"
k_p = 0.1336
k_v = 8.39
[position]
sample_interval_s = 5e-3
[reference]
signal = 'pressure'
kind = "chirp"
amplitude = 3.0e2
[limits]
motor_speed = inf
[noise]
seed = 0x7F
[[process]]
program = "hydro-plant"
cpu = 1
)";

const char kEffects[] =
    "[effects.\"pump.stribeck\"]\nstatic_excess = 0.5\nspeed = 3\n[effects.\"amp.lag\"]\ntau = 0.001\n";

// What a mutation inserts.
const std::vector<std::string> kPieces = {"nan",
                                          "inf",
                                          "-",
                                          "1e999",
                                          "1e308",
                                          "0",
                                          "[",
                                          "]",
                                          "[[",
                                          "{",
                                          "}",
                                          "\"",
                                          "'",
                                          "=",
                                          "\n",
                                          ".",
                                          ",",
                                          "#",
                                          "true",
                                          "2020-01-01",
                                          "\"\"\"",
                                          "\\",
                                          "\\u0000",
                                          std::string(1, '\0'),
                                          "\xff",
                                          "9223372036854775807",
                                          "[model]",
                                          "kind",
                                          "= \"sine\"",
                                          "rate_hz = 1e-300",
                                          "_",
                                          "1979-05-27T07:32:00Z",
                                          "[[[[[[[[[[[[[[[[[[[["};

std::string Mutated(std::string text, std::mt19937_64& random) {
  // Mostly one change, so that many texts get past the parser to the checks behind it.
  const int changes = random() % 4 == 0 ? 4 : 1;
  for (int i = 0; i < changes; ++i) {
    const size_t at = random() % (text.size() + 1);
    switch (random() % 8) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.insert(at, kPieces[random() % kPieces.size()]);
        break;
      case 2:
        text.erase(at, random() % 20);
        break;
      case 3: {
        const std::string piece = text.substr(at, random() % 30);
        text.insert(random() % (text.size() + 1), piece);
        break;
      }
      case 4:
        text.resize(at);
        break;
      default: {  // another digit
        const size_t digit = text.find_first_of("0123456789", at);
        if (digit != std::string::npos) text[digit] = static_cast<char>('0' + random() % 10);
        break;
      }
    }
  }
  return text;
}

// Tests that a mutated text is either taken, and then describes itself, or refused by InputError on one line.
TEST(MutationTest, ConfigurationsNeverCrash) {
  std::mt19937_64 random(20250101);
  int taken = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = Mutated(i % 2 == 0 ? kFullConfig : kConfigText, random);
    try {
      const StackConfig config = Parsed(text);
      ++taken;
      EXPECT_EQ(Parsed(config.text).text, config.text) << text;
      EXPECT_GE(config.position_interval_ticks, 1);
      EXPECT_GE(config.pressure_interval_ticks, 1);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    } catch (const std::exception& error) {
      FAIL() << "not an InputError: " << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(taken, 100) << "the mutations are too wild to test what lies behind the first check";
  EXPECT_LT(taken, 3900);
}

// Tests the same of models.
TEST(MutationTest, ModelsNeverCrash) {
  std::mt19937_64 random(20250102);
  int taken = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = Mutated(i % 2 == 0 ? std::string(kModelText) + kEffects : kModelText, random);
    try {
      const model::ModelDescription model = ParseModel(text, "m.toml");
      ++taken;
      EXPECT_EQ(FormatModel(ParseModel(FormatModel(model), "m.toml")), FormatModel(model));
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    } catch (const std::exception& error) {
      FAIL() << "not an InputError: " << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(taken, 100);
  EXPECT_LT(taken, 3900);
}

// Tests that deep nesting is refused like anything else that is not a configuration.
TEST(MutationTest, DeepNesting) {
  for (const char* piece : {"[", "{a=", "a."}) {
    std::string text = "x = ";
    if (piece[0] == 'a') text = "";
    for (int i = 0; i < 20000; ++i) text += piece;
    EXPECT_NE(InputErrorOf([&] { Parsed(text); }), "") << piece;
  }
}

}  // namespace
}  // namespace hydro::settings
