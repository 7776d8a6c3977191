# One 5 kHz tick of the model by each integrator.
find_package(benchmark REQUIRED)
add_executable(bench_model bench_model.cc)
target_link_libraries(bench_model PRIVATE hydro_model benchmark::benchmark)
