// Violations that lint.odr must find in an object of bn_counted: an inline function outside burnish::bn_*, emitted as a weak symbol, and a
// function of another instruction set.
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
