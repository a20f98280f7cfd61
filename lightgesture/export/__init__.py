"""What another language needs to run the nets, trees and the language: flat files with test vectors."""
