#include "model/response.h"
#include "model/response_pass.h"

namespace hydro::model {

void WidePass(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
              const std::vector<Unknown>& unknowns, size_t first, const ResponseOptions& options,
              Response* response) {
  Pass<Jet>(model, stimulus, start, unknowns, first, options, response);
}

}  // namespace hydro::model
