// Compiles the functions of Boost.Asio and Boost.Beast. All tools link the result.
#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>
