#include <cstdio>
#include <gtest/gtest.h>
#include "model/terms/parameter_info.h"
#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/balances/clean_scan.h"
#include "tests/diagnose/small_runs.h"
#include <ctime>
#include <fstream>
namespace hydro::testing {
static double Now(){ return (double)clock()/CLOCKS_PER_SEC; }
std::vector<diagnose::Change> AllChanges() {
  std::vector<diagnose::Change> changes;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    std::vector<diagnose::Change> here = {{info.id, {}, ""}};
    for (const auto& p : info.parameters) {
      if (!p.is_name()) continue;
      std::vector<diagnose::Change> next;
      for (const auto& c : here) for (const auto& n : p.names) { next.push_back(c); next.back().names[p.name] = n; }
      here = next;
    }
    changes.insert(changes.end(), here.begin(), here.end());
  }
  return changes;
}
void Print(const std::string& what, const std::vector<Comparison>& all, const std::vector<Comparison>& zero) {
  for (size_t i = 0; i < all.size(); ++i) {
    const auto& c = all[i];
    double z=0; for (auto& q: zero) if (q.run==c.run && q.balance==c.balance) z=q.left;
    if (c.said > 2*z) printf("%-40s run %zu %-8s said %9.3g zero %9.3g apart/said %7.4f corr %7.4f ratio %7.4f\n", what.c_str(), c.run, NameOf(c.balance).c_str(), c.said, z, c.apart/c.said, c.correlation, c.correlation*c.left/c.said);
  }
}
TEST(Probe, All) {
  const model::ModelDescription given = Table1With();
  double t0=Now();
  const auto plain = Prepared(MeasureAll(given), given.parameters);
  printf("sim %g\n", Now()-t0); t0=Now();
  for (auto& run : plain) { std::ofstream f("/tmp/coltest_"+run.name+".csv"); for (size_t k=0;k<run.samples();++k) f<<run.stimulus.time[k]<<","<<run.stimulus.voltage[k]<<","<<run.measured.motor_speed.values[k]<<","<<run.measured.p1.values[k]<<","<<run.measured.p2.values[k]<<","<<(run.measured.arm_angle.measured()?run.measured.arm_angle.values[k]:0)<<"\n"; }
  std::vector<size_t> allowed; for (size_t i=0;i<model::BaseParameters().size();++i) allowed.push_back(i);
  const auto sizes = diagnose::SizesOf(given, diagnose::PointersTo(plain));
  const auto variants = diagnose::VariantsOf(AllChanges(), sizes);
  auto scan = ScanClean(given, plain, variants, allowed);
  printf("scan %g, %zu variants %zu columns\n", Now()-t0, variants.size(), scan.table.columns.size());
  const auto zero = Compare(scan, {});
  for (auto& z : zero) printf("zero run %zu %s %g\n", z.run, NameOf(z.balance).c_str(), z.left);
  for (int b=0;b<6;++b) printf("size %g\n", scan.setup.sizes.of[b]);
  for (size_t i : allowed) {
    auto& base = model::BaseParameters()[i];
    int col=-1; for (size_t c=0;c<scan.table.columns.size();++c) if (scan.table.columns[c].name==base.info.name) col=(int)c;
    if (col<0) { printf("no column %s\n", base.info.name.c_str()); continue; }
    auto truth = given;
    double& v = truth.parameters.*base.member;
    double amount = v!=0 ? 0.1 : 1; 
    v = v!=0 ? v*1.1 : amount*scan.setup.units[col];
    auto runs = Prepared(MeasureAll(truth), given.parameters);
    auto s2 = ScanClean(given, runs, {}, {i});
    auto again = s2.Column(base.info.name);
    if (given.parameters.*base.member==0) amount = v/s2.setup.units[again];
    Print(base.info.name, Compare(s2, {{again, amount}}), zero);
  }
  for (size_t v=0; v<variants.size(); ++v) {
    const auto& var = variants[v];
    auto truth = given; truth.effects.push_back(var.at);
    auto run_it = [&](const std::vector<std::pair<std::string,double>>& amounts, const std::string& label) {
      try {
      auto runs = Prepared(MeasureAll(truth), given.parameters);
      auto s2 = ScanClean(given, runs, {var});
      std::vector<Share> shares;
      for (auto& [name, value] : amounts) { int c=s2.Column(var.set+":"+name); shares.push_back({c, var.kind==diagnose::EffectVariant::Kind::kWhole?value:value/s2.setup.units[c]}); }
      Print(label, Compare(s2, shares), zero);
      } catch (const std::exception& e) { printf("%s: %s\n", label.c_str(), e.what()); }
    };
    if (var.kind == diagnose::EffectVariant::Kind::kWave) { printf("wave %s\n", var.set.c_str()); continue; }
    if (var.kind == diagnose::EffectVariant::Kind::kWhole) { run_it({{"whole",1}}, var.set); continue; }
    for (const auto& a : var.amounts) {
      int c = scan.Column(var.set+":"+a);
      double value = var.is_time ? 2e-4 : 0.3*scan.setup.units[c];
      if (value==0) { printf("%s: no unit\n", var.set.c_str()); continue; }
      truth.effects.back().parameters[a]=value;
      run_it({{a,value}}, var.set+":"+a);
      truth.effects.back().parameters[a]=0;
    }
  }
  printf("all %g\n", Now()-t0);
}
}
