// The pictures of a study.
#pragma once

#include <optional>
#include <vector>

#include "batch/report/study_numbers.h"
#include "page/plot.h"

namespace hydro::batch {

// How the cases are distributed, with a panel for each number; empty when there is no number.
std::optional<page::Figure> DistributionsFigure(const StudyNumbers& numbers);

// The cases in the order of the number that decides which are the worst. The worst ones are named.
std::optional<page::Figure> WorstFigure(const StudyNumbers& numbers);

// A number over two keys: the mean of the cases in each cell.
std::optional<page::Figure> SurfaceFigure(const StudyNumbers& numbers);

// Places in the column's vectors, with the worst case first.
std::vector<size_t> WorstPlaces(const NumberColumn& column, size_t count);

}  // namespace hydro::batch
