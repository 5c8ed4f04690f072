"""Effects of one spot: heat, ploughing, severity of abrasion, dents."""
