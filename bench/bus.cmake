# What the bus costs, beside bare LCM on the same work.
find_package(benchmark REQUIRED)
add_executable(bench_bus ${PROJECT_SOURCE_DIR}/bench/bench_bus.cc)
target_link_libraries(bench_bus PRIVATE hydro_bus benchmark::benchmark)
add_executable(bench_lockstep_peer ${PROJECT_SOURCE_DIR}/bench/bench_lockstep_peer.cc)
target_link_libraries(bench_lockstep_peer PRIVATE hydro_lcmtypes)
