"""What compiled code shares: records, calls of emitted functions, small linear algebra."""
