# The cost of a message on the bus, and of lockstep compared with bare LCM in the same pattern.
find_package(benchmark REQUIRED)
add_executable(bench_bus ${PROJECT_SOURCE_DIR}/bench/bench_bus.cc)
target_link_libraries(bench_bus PRIVATE hydro_udpm benchmark::benchmark)
add_executable(bench_lockstep ${PROJECT_SOURCE_DIR}/bench/bench_lockstep.cc)
target_link_libraries(bench_lockstep PRIVATE hydro_udpm hydro_plant_app hydro_pressure_app hydro_position_app)
target_compile_definitions(bench_lockstep PRIVATE HYDRO_BENCH_CONFIG="${PROJECT_SOURCE_DIR}/config/paper.toml")
add_executable(bench_event_source ${PROJECT_SOURCE_DIR}/bench/bench_event_source.cc)
target_link_libraries(bench_event_source PRIVATE hydro_udpm hydro_settings)
add_executable(bench_front_end ${PROJECT_SOURCE_DIR}/bench/bench_front_end.cc)
target_link_libraries(bench_front_end PRIVATE hydro_udpm hydro_front_end hydro_pressure_app spdlog::spdlog)
target_compile_definitions(bench_front_end PRIVATE
  HYDRO_BENCH_CONFIG="${PROJECT_SOURCE_DIR}/config/front_end.toml"
  HYDRO_BENCH_STACK="${PROJECT_SOURCE_DIR}/config/paper.toml"
  HYDRO_BENCH_BOARD="$<TARGET_FILE:hydro-front-end>")
add_dependencies(bench_front_end hydro-front-end)
