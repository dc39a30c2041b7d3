// Violations that lint.odr must find in a bn_counted object. One is an inline function outside burnish::bn_*, emitted as a weak symbol. The
// other belongs to another instruction set.
namespace burnish {
inline __attribute__((noinline)) int leaked(int x)
{
    return x + 1;
}
inline namespace bn_counted {
int caller(int x);
int caller(int x)
{
    return leaked(x);
}
} // namespace bn_counted
inline namespace bn_scalar {
int strange(int x);
int strange(int x)
{
    return x + 2;
}
} // namespace bn_scalar
} // namespace burnish
