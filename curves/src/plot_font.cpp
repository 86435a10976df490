// SPDX-License-Identifier: MIT
// Letters for PNG pictures: strokes on a grid 4 wide and 6 high, the base line at 0, tails to -2.
#include "plot_scene.h"

namespace knotwave::curves {
namespace {

// A glyph is strokes separated by blanks; a stroke is pairs of digits x y. 'a' and 'b' stand for -1
// and -2, for what hangs below the base line.
struct Glyph {
  char letter;
  int width;
  const char* strokes;
};

constexpr Glyph kGlyphs[] = {
    {'0', 4, "103041453616050110"},
    {'1', 3, "052620 1030"},
    {'2', 4, "05163645440040"},
    {'3', 4, "05163645443313 334241301001"},
    {'4', 4, "30360242"},
    {'5', 4, "460604344341301001"},
    {'6', 4, "453616050110304142331302"},
    {'7', 4, "064610"},
    {'8', 4, "13334241301001021304051636454433"},
    {'9', 4, "011030414536160504133344"},
    {'A', 4, "002640 1232"},
    {'B', 4, "00063645443303 3342413000"},
    {'C', 4, "4536160501103041"},
    {'D', 4, "00063645413000"},
    {'E', 4, "46060040 0333"},
    {'F', 4, "460600 0333"},
    {'G', 4, "45361605011030414323"},
    {'H', 4, "0600 4640 0343"},
    {'I', 2, "0626 1610 0020"},
    {'J', 3, "3631201001"},
    {'K', 4, "0600 460340"},
    {'L', 4, "060040"},
    {'M', 4, "0006234640"},
    {'N', 4, "00064046"},
    {'O', 4, "103041453616050110"},
    {'P', 4, "00063645443303"},
    {'Q', 4, "103041453616050110 2240"},
    {'R', 4, "00063645443303 2340"},
    {'S', 4, "453616050413334241301001"},
    {'T', 4, "0646 2620"},
    {'U', 4, "060110304146"},
    {'V', 4, "062046"},
    {'W', 4, "0610233046"},
    {'X', 4, "0640 4600"},
    {'Y', 4, "062346 2320"},
    {'Z', 4, "06460040"},
    {'a', 3, "0314243330 321201102031"},
    {'b', 3, "0600 0314243331201001"},
    {'c', 3, "3324140301102031"},
    {'d', 3, "3630 3324140301102031"},
    {'e', 3, "02323324140301102030"},
    {'f', 2, "261510 0424"},
    {'g', 3, "3324140301102031 343a2b1b0a"},
    {'h', 3, "0600 0314243330"},
    {'i', 0, "0400 0606"},
    {'j', 1, "141a0b 1616"},
    {'k', 3, "0600 340230"},
    {'l', 1, "060110"},
    {'m', 4, "0400 03142320 23344340"},
    {'n', 3, "0400 0314243330"},
    {'o', 3, "102031332414030110"},
    {'p', 3, "040b 0314243331201001"},
    {'q', 3, "343b 3324140301102031"},
    {'r', 2, "0400 031424"},
    {'s', 3, "3414031222312000"},
    {'t', 2, "161120 0424"},
    {'u', 3, "0401102031 3430"},
    {'v', 4, "042044"},
    {'w', 4, "0410233044"},
    {'x', 3, "0430 3400"},
    {'y', 4, "0420 441b"},
    {'z', 3, "04340030"},
    {'.', 0, "0000"},
    {',', 1, "100a"},
    {':', 0, "0303 0000"},
    {';', 1, "0303 100a"},
    {'-', 3, "0333"},
    {'+', 4, "0343 2521"},
    {'=', 3, "0232 0434"},
    {'/', 3, "0a36"},
    {'(', 2, "26050a2b"},
    {')', 2, "06252a0b"},
    {'[', 1, "16060b1b"},
    {']', 1, "06161b0b"},
    {'\'', 0, "0604"},
    {'"', 2, "0604 2624"},
    {'#', 4, "1016 3036 0242 0444"},
    {'%', 4, "0046 0606 4040"},
    {'_', 4, "0a4a"},
    {'*', 4, "2521 0442 0244"},
    {'|', 0, "060b"},
    {'<', 3, "350331"},
    {'>', 3, "053301"},
    {'!', 0, "0602 0000"},
    {'?', 3, "0516263524 2221 2020"},
};

// Strokes are pairs, so reading two characters at a time ends at the end.
constexpr bool are_pairs(const char* strokes) {
  int length = 0;
  for (; *strokes != 0; ++strokes) {
    if (*strokes != ' ') {
      ++length;
    } else if (length % 2 != 0) {
      return false;
    }
  }
  return length % 2 == 0;
}
constexpr bool all_are_pairs() {
  for (const Glyph& glyph : kGlyphs) {
    if (!are_pairs(glyph.strokes)) return false;
  }
  return true;
}
static_assert(all_are_pairs());

int step_of(char digit) { return digit == 'a' ? -1 : digit == 'b' ? -2 : digit - '0'; }

const Glyph* glyph_of(char letter) {
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter == letter) return &glyph;
  }
  return nullptr;
}

// Pixels of one grid step. Letters are 6 steps high, about 0.72 of the size of the type.
double step_px(double size) { return size * 0.12; }

int advance(char letter) {
  const Glyph* glyph = glyph_of(letter);
  return (glyph != nullptr ? glyph->width : 2) + 2;
}

}  // namespace

double text_width(const std::string& text, double size) {
  int steps = 0;
  for (const char letter : text) steps += advance(letter);
  return text.empty() ? 0 : (steps - 2) * step_px(size);
}

std::vector<std::vector<Point>> text_strokes(const std::string& text, double size) {
  std::vector<std::vector<Point>> strokes;
  int left = 0;
  for (const char letter : text) {
    const Glyph* glyph = glyph_of(letter);
    std::vector<Point> stroke;
    for (const char* at = glyph != nullptr ? glyph->strokes : ""; *at != 0;) {
      if (*at == ' ') {
        strokes.push_back(std::move(stroke));
        stroke.clear();
        ++at;
        continue;
      }
      stroke.push_back({(left + step_of(at[0])) * step_px(size), -step_of(at[1]) * step_px(size)});
      at += 2;
    }
    if (!stroke.empty()) strokes.push_back(std::move(stroke));
    left += advance(letter);
  }
  return strokes;
}

}  // namespace knotwave::curves
