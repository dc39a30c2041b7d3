// What lint.odr must find: an inline function outside burnish::bn_*, emitted as a weak symbol.
namespace burnish {
inline __attribute__((noinline)) int leaked(int x) { return x + 1; }
inline namespace bn_scalar {
int caller(int x);
int caller(int x) { return leaked(x); }
} // namespace bn_scalar
} // namespace burnish
