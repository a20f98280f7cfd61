"""The paper's study by simulated users: hand signs, cards, and moved cards, through the product's own decoder."""
