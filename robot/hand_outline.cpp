// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/hand_outline.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "robot/link_pairs.hpp"

namespace opponens::robot {

namespace {

/// The tree of rigid bodies: moving joints only. A body is named by its first link.
struct BodyTree {
  std::vector<int> body;                     ///< [links]
  std::map<int, std::vector<int>> branches;  ///< body -> moving joints that leave it, in the file's order
  std::vector<bool> shaped;                  ///< [joints] whether any link beyond has geometry
};

BodyTree body_tree(const RobotDescription& description) {
  BodyTree tree{rigid_bodies(description), {}, std::vector<bool>(description.joints.size(), false)};
  for (std::size_t j = description.joints.size(); j-- > 0;) {  // children come after their parents
    const Joint& joint = description.joints[j];
    const Link& child = description.links[static_cast<std::size_t>(joint.child)];
    if (!child.collision.empty()) tree.shaped[j] = true;
    const int above = description.links[static_cast<std::size_t>(joint.parent)].joint;
    if (tree.shaped[j] && above >= 0) tree.shaped[static_cast<std::size_t>(above)] = true;
  }
  const bool any = std::find(tree.shaped.begin(), tree.shaped.end(), true) != tree.shaped.end();
  for (std::size_t j = 0; j < description.joints.size(); ++j) {
    const Joint& joint = description.joints[j];
    if (joint.type == JointType::fixed || (any && !tree.shaped[j])) continue;
    tree.branches[tree.body[static_cast<std::size_t>(joint.parent)]].push_back(static_cast<int>(j));
  }
  return tree;
}

const std::vector<int>& branches_of(const BodyTree& tree, int body) {
  static const std::vector<int> kNone;
  const auto found = tree.branches.find(body);
  return found == tree.branches.end() ? kNone : found->second;
}

/// The bodies of the last branchings at or below a body.
void append_branchings(const RobotDescription& description, const BodyTree& tree, int body, std::vector<int>& out) {
  const std::size_t before = out.size();
  for (const int joint : branches_of(tree, body)) {
    append_branchings(description, tree, description.joints[static_cast<std::size_t>(joint)].child, out);
  }
  // A finger that forks at its end (a coupled link) is still a finger: the palm is the body that holds more.
  const std::size_t here = branches_of(tree, body).size();
  const auto more = [&](int other) { return branches_of(tree, other).size() >= here; };
  if (here < 2) return;
  if (std::none_of(out.begin() + static_cast<std::ptrdiff_t>(before), out.end(), more)) {
    out.resize(before);
    out.push_back(body);
  }
}

/// The longest chain of moving joints that begins with one.
std::vector<int> longest_chain(const RobotDescription& description, const BodyTree& tree, int joint) {
  std::vector<int> best;
  for (const int next : branches_of(tree, description.joints[static_cast<std::size_t>(joint)].child)) {
    std::vector<int> chain = longest_chain(description, tree, next);
    if (chain.size() > best.size()) best = std::move(chain);
  }
  best.insert(best.begin(), joint);
  return best;
}

/// The names of a chain's links and joints, in lower case.
std::vector<std::string> texts_of(const RobotDescription& description, const std::vector<int>& chain) {
  std::vector<std::string> texts;
  for (const int index : chain) {
    const Joint& joint = description.joints[static_cast<std::size_t>(index)];
    for (std::string text : {description.links[static_cast<std::size_t>(joint.child)].name, joint.name}) {
      std::transform(text.begin(), text.end(), text.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      texts.push_back(std::move(text));
    }
  }
  return texts;
}

/// What each finger is called by the texts of its chain; empty where they do not say. A word that several fingers have
/// names none of them: "middle" may be a phalanx.
std::vector<std::string> names_in(const std::vector<std::vector<std::string>>& fingers) {
  using Word = std::pair<const char*, const char*>;
  static constexpr std::array<Word, 8> kWords = {{{"thumb", "thumb"},
                                                  {"index", "index"},
                                                  {"middle", "middle"},
                                                  {"medium", "middle"},
                                                  {"ring", "ring"},
                                                  {"little", "little"},
                                                  {"pinky", "little"},
                                                  {"pinkie", "little"}}};
  static constexpr std::array<Word, 5> kBeginnings = {
      {{"th", "thumb"}, {"ff", "index"}, {"mf", "middle"}, {"rf", "ring"}, {"lf", "little"}}};
  std::vector<std::string> names(fingers.size());
  for (const auto& [word, name] : kWords) {
    const auto has_it = [word = word](const std::vector<std::string>& texts) {
      return std::any_of(texts.begin(), texts.end(), [&](const auto& text) { return text.find(word) != text.npos; });
    };
    if (std::count_if(fingers.begin(), fingers.end(), has_it) != 1) continue;
    names[static_cast<std::size_t>(std::find_if(fingers.begin(), fingers.end(), has_it) - fingers.begin())] = name;
  }
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    for (const auto& [word, name] : kBeginnings) {  // the Shadow hand's: FFJ1, mfproximal
      const auto begins = [word = word](const std::string& text) { return text.starts_with(word); };
      if (names[i].empty() && std::all_of(fingers[i].begin(), fingers[i].end(), begins)) names[i] = name;
    }
  }
  return names;
}

/// The finger of the tip that lies on the chain or beyond it.
std::string tip_name(const RobotDescription& description, const std::vector<int>& chain) {
  const int first = description.joints[static_cast<std::size_t>(chain.front())].child;
  for (const SurfacePoint& tip : description.tips) {
    for (int link = tip.link; link >= 0;) {
      if (link == first) return tip.finger;
      const int joint = description.links[static_cast<std::size_t>(link)].joint;
      link = joint < 0 ? -1 : description.joints[static_cast<std::size_t>(joint)].parent;
    }
  }
  return "";
}

}  // namespace

std::optional<int> find_palm(const RobotDescription& description) {
  if (description.links.empty()) return std::nullopt;
  const BodyTree tree = body_tree(description);
  std::vector<int> candidates;
  append_branchings(description, tree, 0, candidates);
  if (candidates.empty()) return std::nullopt;
  const int body = *std::max_element(candidates.begin(), candidates.end(), [&](int a, int b) {
    return branches_of(tree, a).size() < branches_of(tree, b).size();
  });
  std::map<int, int> hanging;  // link of the body -> fingers on it
  for (const int joint : branches_of(tree, body)) ++hanging[description.joints[static_cast<std::size_t>(joint)].parent];
  return std::max_element(hanging.begin(), hanging.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::vector<FingerChain> fingers_of(const RobotDescription& description, int palm) {
  const BodyTree tree = body_tree(description);
  std::vector<FingerChain> fingers;
  std::vector<std::vector<std::string>> texts;
  std::set<std::string> used;
  for (const int joint : branches_of(tree, tree.body[static_cast<std::size_t>(palm)])) {
    FingerChain finger{"", longest_chain(description, tree, joint), false};
    finger.name = tip_name(description, finger.joints);
    if (finger.name.empty() && !description.tips.empty()) continue;
    texts.push_back(texts_of(description, finger.joints));
    fingers.push_back(std::move(finger));
  }
  const std::vector<std::string> words = names_in(texts);
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    std::string& name = fingers[i].name;
    if (name.empty()) name = words[i];
    if (name.empty() || used.contains(name)) name = "finger_" + std::to_string(i + 1);
    used.insert(name);
    fingers[i].thumb = name == "thumb";
  }
  return fingers;
}

}  // namespace opponens::robot
