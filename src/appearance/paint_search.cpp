#include "appearance/paint_search.h"

#include <algorithm>
#include <cctype>

#include "core/colour.h"

namespace livery {

namespace {

/// Words in lower case; hyphens and underlines part them as spaces do.
std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    bool inside = false;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool gap = std::isspace(byte) != 0 || c == '-' || c == '_';
        if (!gap) {
            if (!inside) words.emplace_back();
            words.back() += static_cast<char>(std::tolower(byte));
        }
        inside = !gap;
    }
    return words;
}

/// One letter wrong, missing, too many, or two neighbours swapped.
bool one_mistake_apart(const std::string& a, const std::string& b) {
    if (a.size() > b.size()) return one_mistake_apart(b, a);
    const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin());
    if (x == a.end()) return b.size() <= a.size() + 1;
    if (a.size() < b.size()) return b.size() == a.size() + 1 && std::equal(x, a.end(), y + 1);
    if (std::equal(x + 1, a.end(), y + 1)) return true;
    return x + 1 != a.end() && *x == *(y + 1) && *(x + 1) == *y &&
           std::equal(x + 2, a.end(), y + 2);
}

double word_score(const std::string& typed, const std::vector<std::string>& words) {
    double best = 0.0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        // Earlier words of a name count a little more: "red" means "red metallic" before "dark
        // red".
        const double early = i == 0 ? 0.5 : 0.0;
        if (word == typed) {
            best = std::max(best, 10.0 + early);
        } else if (word.starts_with(typed)) {
            best = std::max(best, 8.0 + early);
        } else if (word.find(typed) != std::string::npos) {
            best = std::max(best, 5.0);
        } else if (typed.size() >= 4 && one_mistake_apart(typed, word.substr(0, typed.size()))) {
            best = std::max(best, 2.0);
        } else if (typed.size() >= 4 && one_mistake_apart(typed, word)) {
            best = std::max(best, 2.0);
        }
    }
    return best;
}

}  // namespace

double search_score(const std::string& query, const std::string& name, const std::string& family) {
    const auto typed = words_of(query);
    if (typed.empty()) return 1.0;
    const auto name_words = words_of(name), family_words = words_of(family);
    double total = 0.0;
    for (const std::string& word : typed) {
        const double score =
            std::max(word_score(word, name_words), 0.4 * word_score(word, family_words));
        if (score == 0.0) return 0.0;
        total += score;
    }
    return total + (typed == name_words ? 100.0 : 0.0);
}

std::vector<std::size_t> search_paints(const std::vector<Material>& paints,
                                       const std::string& query,
                                       const std::string& family) {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t i = 0; i < paints.size(); ++i) {
        if (!family.empty() && paints[i].family != family) continue;
        const double score = search_score(query, paints[i].name, paints[i].family);
        if (score > 0.0) found.emplace_back(score, i);
    }
    std::stable_sort(
        found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::size_t> indices;
    for (const auto& [score, index] : found) indices.push_back(index);
    return indices;
}

std::vector<NearPaint> nearest_colours(std::span<const glm::dvec3> faces_lab10, glm::dvec3 lab10) {
    std::vector<NearPaint> near;
    for (std::size_t i = 0; i < faces_lab10.size(); ++i) {
        near.push_back({i, ciede2000(faces_lab10[i], lab10)});
    }
    std::stable_sort(near.begin(), near.end(), [](const NearPaint& a, const NearPaint& b) {
        return a.de00 < b.de00;
    });
    return near;
}

}  // namespace livery
