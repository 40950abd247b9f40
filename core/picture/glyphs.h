#ifndef CLEAVE_CORE_PICTURE_GLYPHS_H_
#define CLEAVE_CORE_PICTURE_GLYPHS_H_

#include <array>

namespace cleave {

// Letters as strokes of a pen, from ' ' to '~'. A stroke is a list of points, two characters each;
// strokes are parted by blanks. The first character is the way to the right, counted from '0'; the
// second the way up, counted from 'a': 'e' is the baseline, 'm' the height of small letters, 'q'
// that of capitals. Twelve steps are a capital's height.
inline constexpr std::array<const char*, 95> kGlyphs = {
    "",                                    // space
    "0q0i 0f0e",                           // !
    "0q0n 2q2n",                           // "
    "2e4q 5e7q 0i8i 0m8m",                 // #
    "8o6p2p0o0m2k6k8i8g6f2f0g 4r4d",       // $
    "0e8q 1q3p3n1m0n0p1q 7i8h8f7e5f5h7i",  // %
    "8e2m2o3q5q6o6n0h0g2e4e8i",            // &
    "0q0n",                                // '
    "2r0n0f2b",                            // (
    "0r2n2f0b",                            // )
    "3l3q 1m5p 5m1p",                      // *
    "0i6i 3f3l",                           // +
    "1f0c",                                // ,
    "0i4i",                                // -
    "0f0e",                                // .
    "0d6q",                                // /
    "2e0g0o2q5q7o7g5e2e",                  // 0
    "1o4q4e 1e7e",                         // 1
    "0o2q5q7o7m0e7e",                      // 2
    "0o2q5q7o7m5k7i7g5e2e0g 3k5k",         // 3
    "5e5q0h7h",                            // 4
    "7q1q0k2l5l7j7g5e2e0g",                // 5
    "6q3q0n0g2e5e7g7i5k2k0i",              // 6
    "0q7q3e",                              // 7
    "2k0m0o2q5q7o7m5k2k0i0g2e5e7g7i5k",    // 8
    "1e4e7h7o5q2q0o0m2k5k7m",              // 9
    "0f0e 0m0l",                           // :
    "1f0c 1m1l",                           // ;
    "6m0i6e",                              // <
    "0g6g 0k6k",                           // =
    "0m6i0e",                              // >
    "0o2q4q6o6m3k3i 3f3e",                 // ?
    "6h6l3l2j3h6h7g8h8o6q2q0o0g2e7e",      // @
    "0e4q8e 1i7i",                         // A
    "0e0q5q7o7m5k0k 5k8i8g6e0e",           // B
    "8o6q2q0o0g2e6e8g",                    // C
    "0e0q5q8n8h5e0e",                      // D
    "7e0e0q7q 0k5k",                       // E
    "0e0q7q 0k5k",                         // F
    "8o6q2q0o0g2e6e8g8k5k",                // G
    "0e0q 8e8q 0k8k",                      // H
    "0e0q",                                // I
    "5q5g3e1e0f",                          // J
    "0e0q 7q0i 2k7e",                      // K
    "0q0e6e",                              // L
    "0e0q4i8q8e",                          // M
    "0e0q8e8q",                            // N
    "2e0g0o2q6q8o8g6e2e",                  // O
    "0e0q6q8o8l6j0j",                      // P
    "2e0g0o2q6q8o8g6e2e 5h9d",             // Q
    "0e0q6q8o8l6j0j 4j8e",                 // R
    "8o6q2q0o0m2k6k8i8g6e2e0g",            // S
    "0q8q 4q4e",                           // T
    "0q0g2e6e8g8q",                        // U
    "0q4e8q",                              // V
    "0q2e5n8e:q",                          // W
    "0e8q 0q8e",                           // X
    "0q4k8q 4k4e",                         // Y
    "0q8q0e8e",                            // Z
    "2r0r0c2c",                            // [
    "0q6d",                                // backslash
    "0r2r2c0c",                            // ]
    "0n3q6n",                              // ^
    "0c6c",                                // _
    "0q2n",                                // `
    "6m6e 6k4m2m0k0g2e4e6g",               // a
    "0q0e 0g2e4e6g6k4m2m0k",               // b
    "6l4m2m0k0g2e4e6f",                    // c
    "6q6e 6g4e2e0g0k2m4m6k",               // d
    "0i6i6k4m2m0k0g2e5e6f",                // e
    "4q3q2p2e 0m4m",                       // f
    "6m6c4a2a0b 6k4m2m0k0g2e4e6g",         // g
    "0q0e 0k2m4m6k6e",                     // h
    "0m0e 0p0q",                           // i
    "1m1b0a 1p1q",                         // j
    "0q0e 5m0h 2j5e",                      // k
    "0q0f1e",                              // l
    "0m0e 0k2m3m5k5e 5k7m8m:k:e",          // m
    "0m0e 0k2m4m6k6e",                     // n
    "2e0g0k2m4m6k6g4e2e",                  // o
    "0m0a 0g2e4e6g6k4m2m0k",               // p
    "6m6a 6g4e2e0g0k2m4m6k",               // q
    "0m0e 0k2m4m",                         // r
    "6l4m2m0l0j2i4i6h6f4e2e0f",            // s
    "2p2f3e4e 0m4m",                       // t
    "0m0g2e4e6g 6m6e",                     // u
    "0m3e6m",                              // v
    "0m2e4l6e8m",                          // w
    "0e6m 0m6e",                           // x
    "0m3e 6m3e2b0a",                       // y
    "0m6m0e6e",                            // z
    "3r2q2l0j2h2c3b",                      // {
    "0r0b",                                // |
    "0r1q1l3j1h1c0b",                      // }
    "0j2k4i6j",                            // ~
};

// What stands for a code point without letters.
inline constexpr const char* kUnknownGlyph = "0e0q6q6e0e";

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_GLYPHS_H_
