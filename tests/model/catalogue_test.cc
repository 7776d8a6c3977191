// How the catalogue is assembled from the effects' files.
#include "model/effects/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

namespace hydro::testing {
namespace {

using ::testing::HasSubstr;

class Nothing : public model::EffectOf<Nothing> {};

model::CatalogueEntry Entry(const std::string& id) {
  return {.info = {.id = id,
                   .summary = "nothing",
                   .equation = "+ 0",
                   .confused_with = "nothing",
                   .parameters = {{.name = "size", .unit = "1", .meaning = "of nothing"}}},
          .make = model::MakeEffect<Nothing>};
}

std::string ErrorOf(const std::vector<model::CatalogueEntry>& entries) {
  try {
    const model::Catalogue catalogue(entries);
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

// Tests that the order in which effects are added makes no difference.
TEST(Catalogue, IsOrderedById) {
  const model::Catalogue catalogue({Entry("pump.b"), Entry("arm.c"), Entry("pump.a")});
  ASSERT_EQ(catalogue.infos().size(), 3);
  EXPECT_EQ(catalogue.infos()[0].id, "arm.c");
  EXPECT_EQ(catalogue.infos()[1].id, "pump.a");
  EXPECT_EQ(catalogue.infos()[2].id, "pump.b");
  ASSERT_NE(catalogue.Find("pump.a"), nullptr);
  EXPECT_EQ(catalogue.Find("pump.a")->info.id, "pump.a");
  EXPECT_EQ(catalogue.Find("pump.d"), nullptr);
}

// Tests that a duplicate id is an error, wherever the two stand.
TEST(Catalogue, RefusesAnIdThatIsThereTwice) {
  EXPECT_THAT(ErrorOf({Entry("pump.a"), Entry("arm.c"), Entry("pump.a")}),
              HasSubstr("effect \"pump.a\" was added twice"));
}

// Tests that an entry that could not work is refused, naming the effect and what it lacks.
TEST(Catalogue, RefusesEntriesThatCannotWork) {
  using model::Role;
  const auto changed = [](const std::function<void(model::CatalogueEntry*)>& change) {
    model::CatalogueEntry entry = Entry("pump.a");
    change(&entry);
    return ErrorOf({entry});
  };
  const auto parameter = [&](const std::function<void(model::ParameterInfo*)>& change) {
    return changed([&](model::CatalogueEntry* entry) { change(&entry->info.parameters.front()); });
  };
  EXPECT_EQ(changed([](auto*) {}), "");
  EXPECT_THAT(changed([](auto* entry) { entry->make = nullptr; }),
              HasSubstr("\"pump.a\" has nothing that makes it"));
  EXPECT_THAT(changed([](auto* entry) { entry->info.summary = ""; }), HasSubstr("needs an id, a summary"));
  EXPECT_THAT(parameter([](auto* size) { size->unit = ""; }),
              HasSubstr("parameter \"size\" needs a name, a unit"));
  EXPECT_THAT(parameter([](auto* size) { size->max = size->min; }), HasSubstr("not below its max"));
  EXPECT_THAT(parameter([](auto* size) { size->starts = {}; }), HasSubstr("has no starts"));
  EXPECT_THAT(parameter([](auto* size) { size->role = Role::kChannel; }), HasSubstr("but no names"));
  EXPECT_THAT(parameter([](auto* size) { size->role = Role::kPeriods; }), HasSubstr("Role::kTorqueWave"));
  EXPECT_THAT(parameter([](auto* size) { size->role = Role::kDisplacementWave; }),
              HasSubstr("Role::kPeriods"));
  EXPECT_THAT(parameter([](auto* size) { size->role = Role::kPhase; }), HasSubstr("Role::kPeriods"));
}

}  // namespace
}  // namespace hydro::testing
