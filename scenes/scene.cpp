#include "scenes/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace definite::scenes {

std::string Case::Label() const {
  std::string label = fmt::format("{} {} mu={:.3g}", length, filter, mu);
  if (level != 0) label += fmt::format(" level={:g}", level);
  if (substeps != 1) label += fmt::format(" dt=1/{}", 30 * substeps);
  if (!change.empty()) label += fmt::format(" change={}", change);
  return label;
}

const Scene* FindScene(std::string_view name) {
  const auto at = std::ranges::find(AllScenes(), name, &Scene::name);
  return at == AllScenes().end() ? nullptr : &*at;
}

}  // namespace definite::scenes
