# One 5 kHz tick of the model by each integrator.
find_package(benchmark REQUIRED)
add_executable(bench_model bench_model.cc)
target_link_libraries(bench_model PRIVATE hydro_model benchmark::benchmark)

# The cost of an effect that is written as text.
add_executable(bench_formulas bench_formulas.cc)
target_link_libraries(bench_formulas PRIVATE hydro_settings)
target_compile_definitions(bench_formulas PRIVATE HYDRO_SOURCE_DIR="${PROJECT_SOURCE_DIR}")

# The cost of coupling joints by an arm.
add_executable(bench_coupled_arm bench_coupled_arm.cc)
target_link_libraries(bench_coupled_arm PRIVATE hydro_model benchmark::benchmark)
