#include "diagnose/report_html.h"

#include "experiments/typeset.h"

namespace hydro {

std::string ReportHtml(const Diagnosis& diagnosis, bool /*si*/) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Gap "
         "report</title>\n</head>\n<body>\n<p>" +
         EscapeMarkup(diagnosis.sentence) + "</p>\n</body>\n</html>\n";
}

}  // namespace hydro
