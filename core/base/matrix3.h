#ifndef CLEAVE_CORE_BASE_MATRIX3_H_
#define CLEAVE_CORE_BASE_MATRIX3_H_

namespace cleave {

// A 3x3 matrix of T, a number or a batch of them (double4.h), row by row. Aggregates start
// uninitialised, as hot loops want it.
template <typename T>
struct Matrix3 {
  T m[3][3];

  T& operator()(int row, int column) { return m[row][column]; }
  const T& operator()(int row, int column) const { return m[row][column]; }
};

template <typename T>
Matrix3<T> Cofactor(const Matrix3<T>& a) {
  Matrix3<T> cofactor;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor(i, j) = a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
    }
  }
  return cofactor;
}

template <typename T>
T Trace(const Matrix3<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

template <typename T>
Matrix3<T> operator*(const Matrix3<T>& a, const Matrix3<T>& b) {
  Matrix3<T> product;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      product(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return product;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_MATRIX3_H_
