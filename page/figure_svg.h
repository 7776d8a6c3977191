// A figure as a picture, for a page or as a file of its own. Identical figures give identical bytes. Long
// curves are thinned to what the eye can see; extremes are kept.
//
// All functions throw std::invalid_argument, naming `name` and the panel, for a figure that cannot be drawn:
// vectors of unequal length, no panel, nothing to show, an empty range.
#pragma once

#include <string>

#include "page/plot.h"

namespace hydro::page {

// An <svg> element without the caption, for a page that has the style sheet of page/html_page.h.
std::string FigureElement(const Figure& figure, const std::string& name);

// The same in a <figure>, with the caption as text.
std::string HtmlFigure(const Figure& figure, const std::string& name);

// A self-contained SVG document with the caption and the style sheet.
std::string FigureFile(const Figure& figure, const std::string& name);

}  // namespace hydro::page
