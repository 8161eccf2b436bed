// The functions of Boost.Asio and Boost.Beast, compiled once for all tools.
#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>
