// SPDX-License-Identifier: MIT
#include "knotwave/plugins/parameter_values.h"

namespace knotwave::plugins {

ParameterValues::ParameterValues(const ParameterTable& table) : table_(&table) {
  for (std::size_t place = 0; place < kMost; ++place) {
    wanted_[place].store(place < table.size() ? table[place].initial : 0);
  }
  forget_heard();
}

void ParameterValues::set(std::size_t place, double value) KNOTWAVE_RT {
  if (place >= table_->size()) return;
  wanted_[place].store(held((*table_)[place], value), std::memory_order_relaxed);
  has_news_.store(true, std::memory_order_release);
}

double ParameterValues::get(std::size_t place) const KNOTWAVE_RT {
  return place < table_->size() ? wanted_[place].load(std::memory_order_relaxed) : 0;
}

double ParameterValues::set_heard(std::size_t place, double value) KNOTWAVE_RT {
  set(place, value);
  return heard_[place] = held((*table_)[place], value);
}

void ParameterValues::forget_heard() {
  for (std::size_t place = 0; place < table_->size(); ++place) {
    heard_[place] = (*table_)[place].initial;
  }
  has_news_.store(true);
}

}  // namespace knotwave::plugins
