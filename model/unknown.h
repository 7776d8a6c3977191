// What may be unknown in a model and in a run: the directions of derivatives.
#pragma once

#include <cstddef>

namespace hydro::model {

// A quantity by which a response or a balance is differentiated.
struct Unknown {
  enum class Kind {
    kBase,    // a base parameter: `index` as in BaseParameters()
    kEffect,  // a parameter of an effect: `index` as in EffectParameters()
    kStart,   // a number of the start: `index` in StartState
  };
  Kind kind = Kind::kBase;
  size_t index = 0;

  bool operator==(const Unknown&) const = default;
};

}  // namespace hydro::model
